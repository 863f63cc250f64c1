#include "hw_drivers/v4l2/fake/node.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include <linux/videodev2.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <unistd.h>

#include "core/base/error.h"

namespace enc::v4l2 {
namespace {

constexpr std::uint32_t kCapture = V4L2_BUF_TYPE_VIDEO_CAPTURE;
constexpr std::uint32_t kMostBuffers = 32;

template <std::size_t N>
void put_text(const std::string& text, unsigned char (&field)[N]) {
  std::memset(field, 0, N);
  std::memcpy(field, text.data(), std::min(text.size(), N - 1));
}

v4l2_fract interval_of(double rate) { return {1000, static_cast<std::uint32_t>(std::lround(1000.0 * rate))}; }

}  // namespace

Node::Node(NodeSpec spec)
    : spec_(std::move(spec)),
      mode_(spec_.modes.front()),
      event_(::eventfd(0, EFD_SEMAPHORE | EFD_NONBLOCK | EFD_CLOEXEC)) {
  if (event_ < 0) throw Error("a fake camera gets no eventfd; end some programs", {}, ErrorKind::device);
}

Node::~Node() {
  release();
  ::close(event_);
}

std::size_t Node::frame_bytes() const {
  return row_bytes(mode_.pixels, static_cast<std::size_t>(mode_.width)) *
         static_cast<std::size_t>(mode_.height);
}

template <class Data>
int Node::answer(int client, std::span<std::byte> data, int (Node::*what)(int, Data&)) {
  if (data.size() != sizeof(Data)) return -EINVAL;
  Data copy;  // the bytes may lie anywhere
  std::memcpy(&copy, data.data(), sizeof(Data));
  const int result = (this->*what)(client, copy);
  std::memcpy(data.data(), &copy, sizeof(Data));
  return result;
}

int Node::control(int client, std::uint32_t request, std::span<std::byte> data) {
  switch (request) {
    case VIDIOC_QUERYCAP:
      return answer(client, data, &Node::query);
    case VIDIOC_ENUM_FMT:
      return answer(client, data, &Node::list_format);
    case VIDIOC_ENUM_FRAMESIZES:
      return answer(client, data, &Node::list_size);
    case VIDIOC_ENUM_FRAMEINTERVALS:
      return answer(client, data, &Node::list_rate);
    case VIDIOC_G_FMT:
      return answer(client, data, &Node::get_format);
    case VIDIOC_S_FMT:
      return answer(client, data, &Node::set_format);
    case VIDIOC_G_PARM:
      return answer(client, data, &Node::get_rate);
    case VIDIOC_S_PARM:
      return answer(client, data, &Node::set_rate);
    case VIDIOC_REQBUFS:
      return answer(client, data, &Node::request);
    case VIDIOC_QUERYBUF:
      return answer(client, data, &Node::query_buffer);
    case VIDIOC_QBUF:
      return answer(client, data, &Node::queue);
    case VIDIOC_DQBUF:
      return answer(client, data, &Node::dequeue);
    case VIDIOC_STREAMON:
      return answer(client, data, &Node::begin);
    case VIDIOC_STREAMOFF:
      return answer(client, data, &Node::end);
    default:
      return -ENOTTY;
  }
}

// ---- what the camera is

int Node::query(int, v4l2_capability& data) {
  data = {};
  put_text("uvcvideo", data.driver);
  put_text(spec_.card, data.card);
  put_text(spec_.bus, data.bus_info);
  data.version = 0x060100;
  data.device_caps = (spec_.captures ? V4L2_CAP_VIDEO_CAPTURE : V4L2_CAP_META_CAPTURE) | V4L2_CAP_STREAMING |
                     V4L2_CAP_EXT_PIX_FORMAT;
  data.capabilities = data.device_caps | V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_DEVICE_CAPS;
  return 0;
}

// Each format once, in the order of the modes.
int Node::list_format(int, v4l2_fmtdesc& data) {
  if (data.type != kCapture || !spec_.captures) return -EINVAL;
  std::vector<Pixels> all;
  for (const Mode& mode : spec_.modes)
    if (std::find(all.begin(), all.end(), mode.pixels) == all.end()) all.push_back(mode.pixels);
  if (data.index >= all.size()) return -EINVAL;
  const std::uint32_t index = data.index;
  data = {};
  data.index = index;
  data.type = kCapture;
  data.pixelformat = code_of(all[index]);
  data.flags = all[index] == Pixels::mjpeg ? V4L2_FMT_FLAG_COMPRESSED : 0;
  put_text(std::string(word_of(all[index])), data.description);
  return 0;
}

int Node::list_size(int, v4l2_frmsizeenum& data) {
  std::uint32_t at = 0;
  std::vector<std::pair<int, int>> listed;
  for (const Mode& mode : spec_.modes) {
    const std::pair size{mode.width, mode.height};
    if (code_of(mode.pixels) != data.pixel_format ||
        std::find(listed.begin(), listed.end(), size) != listed.end())
      continue;
    listed.push_back(size);
    if (at++ != data.index) continue;
    data.type = V4L2_FRMSIZE_TYPE_DISCRETE;
    data.discrete = {static_cast<std::uint32_t>(mode.width), static_cast<std::uint32_t>(mode.height)};
    return 0;
  }
  return -EINVAL;
}

int Node::list_rate(int, v4l2_frmivalenum& data) {
  std::uint32_t at = 0;
  for (const Mode& mode : spec_.modes) {
    if (code_of(mode.pixels) != data.pixel_format || static_cast<std::uint32_t>(mode.width) != data.width ||
        static_cast<std::uint32_t>(mode.height) != data.height || at++ != data.index)
      continue;
    data.type = V4L2_FRMIVAL_TYPE_DISCRETE;
    data.discrete = interval_of(mode.rate);
    return 0;
  }
  return -EINVAL;
}

// ---- format and rate

int Node::get_format(int, v4l2_format& data) {
  if (data.type != kCapture || !spec_.captures) return -EINVAL;
  data.fmt = {};
  v4l2_pix_format& pixels = data.fmt.pix;
  pixels.width = static_cast<std::uint32_t>(mode_.width);
  pixels.height = static_cast<std::uint32_t>(mode_.height);
  pixels.pixelformat = code_of(mode_.pixels);
  pixels.field = V4L2_FIELD_NONE;
  pixels.bytesperline =
      mode_.pixels == Pixels::mjpeg ? 0 : static_cast<std::uint32_t>(row_bytes(mode_.pixels, pixels.width));
  pixels.sizeimage = static_cast<std::uint32_t>(frame_bytes());
  pixels.colorspace = V4L2_COLORSPACE_SRGB;
  return 0;
}

// Takes the nearest mode, with the format before the size, as uvcvideo does.
int Node::set_format(int client, v4l2_format& data) {
  if (data.type != kCapture || !spec_.captures) return -EINVAL;
  if (owner_ >= 0) return -EBUSY;
  const v4l2_pix_format& pixels = data.fmt.pix;
  const auto distance = [&](const Mode& mode) {
    const double side = std::abs(static_cast<double>(pixels.width) - mode.width) +
                        std::abs(static_cast<double>(pixels.height) - mode.height);
    return (code_of(mode.pixels) == pixels.pixelformat ? 0.0 : 1e12) + side;
  };
  mode_ = *std::min_element(spec_.modes.begin(), spec_.modes.end(),
                            [&](const Mode& a, const Mode& b) { return distance(a) < distance(b); });
  return get_format(client, data);
}

int Node::get_rate(int, v4l2_streamparm& data) {
  if (data.type != kCapture || !spec_.captures) return -EINVAL;
  data.parm = {};
  data.parm.capture.capability = V4L2_CAP_TIMEPERFRAME;
  data.parm.capture.timeperframe = interval_of(mode_.rate);
  return 0;
}

int Node::set_rate(int client, v4l2_streamparm& data) {
  if (data.type != kCapture || !spec_.captures) return -EINVAL;
  if (busy(client) || streams_) return -EBUSY;
  const v4l2_fract wish = data.parm.capture.timeperframe;
  const double rate =
      wish.numerator == 0 ? mode_.rate : wish.denominator / static_cast<double>(wish.numerator);
  Mode best = mode_;
  for (const Mode& mode : spec_.modes)
    if (mode.pixels == mode_.pixels && mode.width == mode_.width && mode.height == mode_.height &&
        std::abs(mode.rate - rate) < std::abs(best.rate - rate))
      best = mode;
  mode_ = best;
  return get_rate(client, data);
}

// ---- buffers

void Node::forget_frames() {
  std::uint64_t count = 0;
  while (::read(event_, &count, sizeof(count)) == static_cast<ssize_t>(sizeof(count))) continue;
  queued_.clear();
  filled_.clear();
  is_queued_.assign(count_, false);
}

void Node::release() {
  streams_ = false;
  if (bytes_ != nullptr) ::munmap(bytes_, count_ * each_);
  if (memory_ >= 0) ::close(memory_);
  bytes_ = nullptr;
  memory_ = owner_ = -1;
  count_ = each_ = 0;
  forget_frames();
}

void Node::leave(int client) {
  if (owner_ == client) release();
}

int Node::request(int client, v4l2_requestbuffers& data) {
  if (data.type != kCapture || data.memory != V4L2_MEMORY_MMAP || !spec_.captures) return -EINVAL;
  if (busy(client) || streams_) return -EBUSY;
  release();
  data.count = std::min(data.count, kMostBuffers);
  data.capabilities = V4L2_BUF_CAP_SUPPORTS_MMAP;
  if (data.count == 0) return 0;
  constexpr std::size_t kPage = 4096;
  each_ = (frame_bytes() + kPage - 1) / kPage * kPage;
  memory_ = ::memfd_create("encounter_camera", MFD_CLOEXEC);
  const std::size_t all = data.count * each_;
  void* at = memory_ < 0 || ::ftruncate(memory_, static_cast<off_t>(all)) != 0
                 ? MAP_FAILED
                 : ::mmap(nullptr, all, PROT_READ | PROT_WRITE, MAP_SHARED, memory_, 0);
  if (at == MAP_FAILED) {
    release();
    return -ENOMEM;
  }
  bytes_ = static_cast<std::uint8_t*>(at);
  count_ = data.count;
  owner_ = client;
  forget_frames();
  return 0;
}

int Node::query_buffer(int client, v4l2_buffer& data) {
  if (busy(client)) return -EBUSY;
  if (data.type != kCapture || data.index >= count_) return -EINVAL;
  const std::uint32_t index = data.index;
  data = {};
  data.index = index;
  data.type = kCapture;
  data.memory = V4L2_MEMORY_MMAP;
  data.length = static_cast<std::uint32_t>(frame_bytes());
  data.m.offset = static_cast<std::uint32_t>(index * each_);
  data.flags = V4L2_BUF_FLAG_MAPPED | V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  return 0;
}

int Node::queue(int client, v4l2_buffer& data) {
  if (busy(client)) return -EBUSY;
  if (data.type != kCapture || data.memory != V4L2_MEMORY_MMAP || data.index >= count_) return -EINVAL;
  if (is_queued_[data.index]) return -EINVAL;
  is_queued_[data.index] = true;
  queued_.push_back(data.index);
  return 0;
}

int Node::dequeue(int client, v4l2_buffer& data) {
  if (busy(client)) return -EBUSY;
  if (data.type != kCapture || data.memory != V4L2_MEMORY_MMAP || !streams_) return -EINVAL;
  if (error_ != 0) return -error_;
  if (filled_.empty()) return -EAGAIN;
  const FilledBuffer frame = filled_.front();
  filled_.pop_front();
  std::uint64_t one = 0;
  static_cast<void>(::read(event_, &one, sizeof(one)));
  data = {};
  data.index = frame.index;
  data.type = kCapture;
  data.memory = V4L2_MEMORY_MMAP;
  data.bytesused = frame.used;
  data.length = static_cast<std::uint32_t>(frame_bytes());
  data.sequence = frame.sequence;
  data.field = V4L2_FIELD_NONE;
  data.flags = V4L2_BUF_FLAG_MAPPED |
               (spec_.stamps ? V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE
                             : V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN) |
               (frame.damaged ? V4L2_BUF_FLAG_ERROR : 0U);
  data.timestamp.tv_sec = frame.stamp.count() / 1'000'000'000;
  data.timestamp.tv_usec = frame.stamp.count() % 1'000'000'000 / 1'000;
  is_queued_[frame.index] = false;
  return 0;
}

int Node::begin(int client, int& type) {
  if (busy(client)) return -EBUSY;
  if (type != static_cast<int>(kCapture) || count_ == 0) return -EINVAL;
  streams_ = true;
  return 0;
}

int Node::end(int client, int& type) {
  if (busy(client)) return -EBUSY;
  if (type != static_cast<int>(kCapture)) return -EINVAL;
  streams_ = false;
  forget_frames();
  return 0;
}

bool Node::put(std::uint32_t sequence, Duration stamp, std::span<const std::uint8_t> bytes, bool damaged) {
  if (!streams_ || queued_.empty()) return false;
  const std::uint32_t index = queued_.front();
  queued_.pop_front();
  const std::size_t used = std::min(bytes.size(), frame_bytes());
  std::copy_n(bytes.begin(), used, bytes_ + index * each_);
  filled_.push_back({index, sequence, static_cast<std::uint32_t>(used), stamp, damaged});
  const std::uint64_t one = 1;
  static_cast<void>(::write(event_, &one, sizeof(one)));
  return true;
}

}  // namespace enc::v4l2
