// Live cameras: frames of a video device, answers of its kernel driver, and calls that reach a fake one.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <linux/videodev2.h>
#include <sys/ioctl.h>

#include "core/base/error.h"
#include "hw_drivers/v4l2/drive/video_device.h"
#include "hw_drivers/v4l2/fake/encode.h"
#include "hw_drivers/v4l2/fake/node.h"
#include "tests/fuzz/machine/fuzzing.h"
#include "tests/fuzz/targets/seeds.h"

namespace enc::fuzz {
namespace {

using v4l2::Mode, v4l2::Pixels;

constexpr int kWide = 24, kHigh = 9;

Image seen() {
  Image image(kWide, kHigh);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = static_cast<std::uint8_t>(5 * i);
  return image;
}

std::string bytes_in(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }
std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// ---- frames: an accepted one has the size that was negotiated

Target frame() {
  Target target;
  v4l2::Encoder encoder;
  for (const Pixels pixels : {Pixels::mjpeg, Pixels::yuyv, Pixels::grey, Pixels::rgb})
    target.seeds.push_back(bytes_in(encoder.encode(pixels, seen().view())));
  target.tokens = jpeg_tokens();
  target.run = [](const std::string& input) {
    static v4l2::Decoder decoder;
    bool any = false;
    for (const Pixels pixels : {Pixels::mjpeg, Pixels::yuyv, Pixels::grey, Pixels::rgb}) {
      const std::size_t stride = v4l2::row_bytes(pixels, kWide);
      Image left, right;
      if (decoder.whole(bytes_of(input), {pixels, kWide, kHigh, stride}, left)) {
        expect(left.width == kWide && left.height == kHigh, "a frame has another size");
        any = true;
      }
      if (decoder.halves(bytes_of(input), {pixels, kWide, kHigh, stride}, left, right))
        expect(left.width == kWide / 2 && right.width == kWide / 2 && right.height == kHigh,
               "half a frame has another size");
    }
    return any;
  };
  return target;
}

// ---- answers of a kernel driver, one after the other: an error number, and the struct of the call

class Answers final : public v4l2::System {
 public:
  explicit Answers(const std::string& input) : input_(input) {}
  int open(const std::string&) noexcept override { return 3; }
  void close(int) noexcept override {}
  int control(int, unsigned long request, void* data) noexcept override {
    if (at_ >= input_.size()) return -ENODEV;
    const int result = -static_cast<unsigned char>(input_[at_++]);
    const std::size_t size = std::min<std::size_t>(_IOC_SIZE(request), input_.size() - at_);
    std::memcpy(data, input_.data() + at_, size);
    at_ += size;
    return result;
  }
  void* map(int, std::size_t size, std::int64_t) noexcept override {
    return size <= memory_.size() ? memory_.data() : nullptr;
  }
  void unmap(void*, std::size_t) noexcept override {}
  void wait(std::span<const int>, Duration) noexcept override {}
  Duration now() noexcept override { return {}; }

 private:
  const std::string& input_;
  std::size_t at_ = 0;
  std::vector<std::uint8_t> memory_ = std::vector<std::uint8_t>(8192);
};

// A whole conversation with a fake device, as its driver's answers.
class Recorder final : public v4l2::System {
 public:
  int open(const std::string&) noexcept override { return 3; }
  void close(int) noexcept override {}
  int control(int, unsigned long request, void* data) noexcept override {
    const std::span all(static_cast<std::byte*>(data), _IOC_SIZE(request));
    const auto number = static_cast<std::uint32_t>(request);
    calls_.append(reinterpret_cast<const char*>(&number), sizeof(number)).append(text_of(all));
    const int result = node_.control(3, number, all);
    answers_ += static_cast<char>(-result);
    answers_ += text_of(all);
    return result;
  }
  void* map(int, std::size_t, std::int64_t) noexcept override { return memory_.data(); }
  void unmap(void*, std::size_t) noexcept override {}
  void wait(std::span<const int>, Duration) noexcept override {}
  Duration now() noexcept override { return {}; }

  v4l2::Node node_{{.modes = {Mode{Pixels::grey, kWide, kHigh, 20.0}}}};
  std::string calls_, answers_;
  std::vector<std::uint8_t> memory_ = std::vector<std::uint8_t>(8192);
};

const v4l2::StreamRequest kWanted{Pixels::grey, kWide, kHigh, 20.0, 2};

Recorder& conversation() {
  static Recorder recorder;
  if (!recorder.calls_.empty()) return recorder;
  v4l2::VideoDevice device(recorder, "fuzz", kWanted);
  v4l2::RawFrame frame;
  frame.bytes.resize(device.frame_bytes());
  const std::vector<std::uint8_t> grey(static_cast<std::size_t>(kWide) * kHigh, 7);
  for (const std::uint32_t number : {4U, 6U}) {
    recorder.node_.put(number, Duration(number), grey);
    expect(device.take(frame) == v4l2::VideoDevice::TakeResult::frame, "the fake sends no frame");
  }
  return recorder;
}

Target answers() {
  Target target;
  target.seeds = {conversation().answers_};
  target.tokens = {
      "GREY", "YUYV", "RGB3", std::string(4, '\0'), std::string(4, '\xff'), std::string("\0\0\0\x80", 4)};
  target.run = [](const std::string& input) {
    Answers system(input);
    v4l2::VideoDevice device(system, "fuzz", kWanted);
    v4l2::RawFrame frame;
    frame.bytes.resize(device.frame_bytes());
    for (int i = 0; i < 4; ++i) {
      static_cast<void>(device.take(frame));
      expect(frame.used <= frame.bytes.size(), "a frame is longer than its memory");
    }
    expect(device.raster().stride >= kWide, "a row is too short");
    v4l2::Decoder decoder;
    Image image;
    static_cast<void>(decoder.whole(frame.view(), device.raster(), image));
    return true;
  };
  return target;
}

// ---- calls that reach a fake: a request and its struct, again and again

Target calls() {
  Target target;
  target.seeds = {conversation().calls_};
  for (const std::uint32_t request :
       {VIDIOC_QBUF, VIDIOC_DQBUF, VIDIOC_REQBUFS, VIDIOC_S_FMT, VIDIOC_STREAMON})
    target.tokens.emplace_back(reinterpret_cast<const char*>(&request), sizeof(request));
  target.run = [](const std::string& input) {
    v4l2::Node node({.modes = {Mode{Pixels::grey, kWide, kHigh, 20.0}}});
    std::array<std::byte, 256> data{};
    bool any = false;
    for (std::size_t at = 0; at + 4 <= input.size();) {
      std::uint32_t request = 0;
      std::memcpy(&request, input.data() + at, 4);
      at += 4;
      const std::size_t size = std::min({std::size_t{_IOC_SIZE(request)}, data.size(), input.size() - at});
      std::memcpy(data.data(), input.data() + at, size);
      at += size;
      const int result = node.control(static_cast<int>(at % 2), request, std::span(data).first(size));
      expect(result <= 0 && result > -134, "an answer is no error number");
      any = any || result == 0;
      node.put(1, {}, bytes_of(input));
    }
    return any;
  };
  return target;
}

const Offer kFrame("v4l2_frame", &frame), kAnswers("v4l2_answers", &answers), kCalls("v4l2_calls", &calls);

}  // namespace
}  // namespace enc::fuzz
