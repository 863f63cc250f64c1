#include "hw_drivers/v4l2/drive/video_device.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <linux/videodev2.h>

#include "core/base/error.h"
#include "hw_drivers/net/socket.h"
#include "hw_drivers/v4l2/drive/offered.h"

namespace enc::v4l2 {
namespace {

constexpr std::int64_t kMostSeconds = 4'000'000'000;  // of a stamp: more would overflow as nanoseconds

// Largest frame that memory is kept for. Drivers round up, and a JPEG is smaller than its pixels.
std::size_t most_bytes(const StreamRequest& wanted) {
  return 4 * static_cast<std::size_t>(wanted.width) * static_cast<std::size_t>(wanted.height) + (1U << 20U);
}

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw Error(path + ": " + what, {}, ErrorKind::device);
}

[[noreturn]] void refuse(const std::string& path, int error, const char* call) {
  if (error == EBUSY)
    refuse(path, "another program uses it; expected a free camera; end that program (fuser -v " + path + ")");
  if (error == ENODEV || error == ENXIO)
    refuse(path, "no camera is behind it any more; expected a connected one; plug it in");
  refuse(path, fmt::format("refuses {}: {}; expected a camera that streams; try it with v4l2-ctl -d {} --all",
                           call, std::strerror(error), path));
}

[[noreturn]] void refuse_open(const std::string& path, int error) {
  if (error == ENOENT)
    refuse(path, "is not there; expected a camera; plug it in, or see `ls /dev/v4l/by-path /dev/video*`");
  if (error == EACCES || error == EPERM)
    refuse(path, fmt::format("you may not open it; expected a member of the group '{}'; run as root "
                             "`usermod -aG {} USER`, and log in again",
                             group_of(path), group_of(path)));
  if (error == ENOTTY)
    refuse(path, "is no device; expected a video device such as /dev/video0; correct `left` or `right`");
  if (error == ECONNREFUSED)
    refuse(path, "no fake camera listens there; expected one; start `encounter fake RIG` first");
  refuse(path, error, "to be opened");
}

// Text of a fixed length, which may lack its end.
template <std::size_t N>
std::string text_in(const unsigned char (&field)[N]) {
  const auto* text = reinterpret_cast<const char*>(field);
  return net::printable(std::string_view(text, strnlen(text, N)));
}

}  // namespace

VideoDevice::VideoDevice(System& system, const std::string& path, const StreamRequest& wanted)
    : system_(system), path_(path) {
  open();
  try {
    identify();
    set_format(wanted);
    set_rate(wanted);
    share_buffers(wanted);
    begin();
  } catch (...) {
    close();
    throw;
  }
}

VideoDevice::~VideoDevice() { close(); }

void VideoDevice::close() noexcept {
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (streams_) static_cast<void>(system_.control(descriptor_, VIDIOC_STREAMOFF, &type));
  streams_ = false;
  for (const SharedBuffer& one : buffers_) system_.unmap(one.memory, one.size);
  buffers_.clear();
  if (descriptor_ >= 0) system_.close(descriptor_);
  descriptor_ = -1;
}

void VideoDevice::open() {
  const int result = system_.open(path_);
  if (result < 0) refuse_open(path_, -result);
  descriptor_ = result;
}

void VideoDevice::identify() {
  v4l2_capability is{};
  if (const int result = system_.control(descriptor_, VIDIOC_QUERYCAP, &is);
      result == -ENOTTY || result == -EINVAL)
    refuse(path_, "is no video device; expected one such as /dev/video0; correct `left` or `right`");
  else if (result != 0)
    refuse(path_, -result, "VIDIOC_QUERYCAP");
  card_ = text_in(is.card);
  bus_ = text_in(is.bus_info);
  const std::uint32_t can = (is.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? is.device_caps : is.capabilities;
  if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0 || (can & V4L2_CAP_STREAMING) == 0)
    refuse(path_, fmt::format("'{}' sends no images there; expected a device that captures and streams; try "
                              "another of its devices (v4l2-ctl --list-devices)",
                              card_));
}

void VideoDevice::set_format(const StreamRequest& wanted) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  v4l2_pix_format& pixels = format.fmt.pix;
  pixels.width = static_cast<std::uint32_t>(wanted.width);
  pixels.height = static_cast<std::uint32_t>(wanted.height);
  pixels.pixelformat = code_of(wanted.pixels);
  pixels.field = V4L2_FIELD_NONE;
  const int result = system_.control(descriptor_, VIDIOC_S_FMT, &format);
  if (result != 0 && result != -EINVAL) refuse(path_, -result, "VIDIOC_S_FMT");
  if (result != 0 || pixels.width != static_cast<std::uint32_t>(wanted.width) ||
      pixels.height != static_cast<std::uint32_t>(wanted.height) ||
      pixels.pixelformat != code_of(wanted.pixels)) {
    const std::string offers = offered_by(system_, descriptor_);
    refuse(path_,
           fmt::format("gives {} {} x {} px; expected {} {} x {} px, by the rig file; set format here, "
                       "or width_px and height_px of [camera]{}{}",
                       text_of(pixels.pixelformat), pixels.width, pixels.height, word_of(wanted.pixels),
                       wanted.width, wanted.height, offers.empty() ? "" : "; it offers ", offers));
  }
  const std::size_t row = row_bytes(wanted.pixels, static_cast<std::size_t>(wanted.width));
  raster_ = {wanted.pixels, wanted.width, wanted.height, std::max<std::size_t>(pixels.bytesperline, row)};
  frame_bytes_ = pixels.sizeimage;
  if (frame_bytes_ == 0 || frame_bytes_ > most_bytes(wanted))
    refuse(path_, fmt::format("has frames of {} bytes; expected 1 to {}; use another driver of the kernel",
                              frame_bytes_, most_bytes(wanted)));
}

// Not every device can report or change its rate.
void VideoDevice::set_rate(const StreamRequest& wanted) {
  v4l2_streamparm stream{};
  stream.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (system_.control(descriptor_, VIDIOC_G_PARM, &stream) != 0) return;
  v4l2_captureparm& capture = stream.parm.capture;
  if ((capture.capability & V4L2_CAP_TIMEPERFRAME) != 0) {
    capture.timeperframe = {1'000'000, static_cast<std::uint32_t>(std::lround(wanted.rate * 1e6))};
    if (const int result = system_.control(descriptor_, VIDIOC_S_PARM, &stream); result != 0)
      refuse(path_, -result, "VIDIOC_S_PARM");
  }
  if (capture.timeperframe.numerator == 0 || capture.timeperframe.denominator == 0) return;
  rate_ = capture.timeperframe.denominator / static_cast<double>(capture.timeperframe.numerator);
  constexpr double kSame = 0.01;  // a share: 29.97 Hz is 30 Hz
  if (std::abs(rate_ - wanted.rate) <= kSame * wanted.rate) return;
  const std::string offers = offered_by(system_, descriptor_);
  refuse(path_, fmt::format("gives {:.4g} frames a second; expected {:.4g}, by the rig file; set rate_hz of "
                            "[camera]{}{}",
                            rate_, wanted.rate, offers.empty() ? "" : "; it offers ", offers));
}

void VideoDevice::share_buffers(const StreamRequest& wanted) {
  v4l2_requestbuffers request{};
  request.count = static_cast<std::uint32_t>(wanted.buffers);
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  if (const int result = system_.control(descriptor_, VIDIOC_REQBUFS, &request); result != 0)
    refuse(path_, -result, "VIDIOC_REQBUFS");
  constexpr std::uint32_t kFewest = 2, kMost = 32;
  if (request.count < kFewest)
    refuse(path_, fmt::format("has memory for {} buffers; expected {}; end other programs with cameras",
                              request.count, kFewest));
  for (std::uint32_t i = 0; i < std::min(request.count, kMost); ++i) {
    v4l2_buffer buffer{};
    buffer.index = i;
    buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    buffer.memory = V4L2_MEMORY_MMAP;
    if (const int result = system_.control(descriptor_, VIDIOC_QUERYBUF, &buffer); result != 0)
      refuse(path_, -result, "VIDIOC_QUERYBUF");
    void* memory = buffer.length == 0 || buffer.length > most_bytes(wanted)
                       ? nullptr
                       : system_.map(descriptor_, buffer.length, buffer.m.offset);
    if (memory == nullptr) refuse(path_, ENOMEM, "mmap");
    buffers_.push_back({static_cast<std::uint8_t*>(memory), buffer.length});
    frame_bytes_ = std::max<std::size_t>(frame_bytes_, buffer.length);
    if (!queue(i)) refuse(path_, EIO, "VIDIOC_QBUF");
  }
}

void VideoDevice::begin() {
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (const int result = system_.control(descriptor_, VIDIOC_STREAMON, &type); result != 0) {
    if (result == -ENOSPC)
      refuse(path_,
             "the USB bus has no bandwidth left for it; expected a bus of its own; use MJPG, or another "
             "port");
    refuse(path_, -result, "VIDIOC_STREAMON");
  }
  streams_ = true;
}

bool VideoDevice::queue(std::uint32_t index) noexcept {
  v4l2_buffer buffer{};
  buffer.index = index;
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  return system_.control(descriptor_, VIDIOC_QBUF, &buffer) == 0;
}

VideoDevice::TakeResult VideoDevice::take(RawFrame& into) noexcept {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  const int result = system_.control(descriptor_, VIDIOC_DQBUF, &buffer);
  if (result == -EAGAIN) return TakeResult::nothing;
  if (result == -EIO) return TakeResult::damaged;  // a transient fault; the buffer stays with the kernel
  if (result != 0 || buffer.index >= buffers_.size()) return TakeResult::gone;
  if (const std::uint32_t gap = buffer.sequence - sequence_ - 1; any_ && gap < 1U << 31U) lost_ += gap;
  any_ = true;
  sequence_ = buffer.sequence;
  const SharedBuffer& from = buffers_[buffer.index];
  const timeval& stamp = buffer.timestamp;
  stamps_ = (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC &&
            stamp.tv_sec >= 0 && stamp.tv_sec < kMostSeconds && stamp.tv_usec >= 0 &&
            stamp.tv_usec < 1'000'000 &&
            (stamp.tv_sec > 0 || stamp.tv_usec > 0);  // a driver that sets no stamp leaves 0
  begins_ = (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  into.stamp = stamps_ ? Duration(stamp.tv_sec * 1'000'000'000LL + stamp.tv_usec * 1'000LL) : system_.now();
  into.used = std::min({std::size_t{buffer.bytesused}, from.size, into.bytes.size()});
  std::copy_n(from.memory, into.used, into.bytes.begin());
  const bool damaged = (buffer.flags & V4L2_BUF_FLAG_ERROR) != 0 || into.used == 0;
  if (!queue(buffer.index)) return TakeResult::gone;
  return damaged ? TakeResult::damaged : TakeResult::frame;
}

std::string VideoDevice::name() const {
  return fmt::format("{} ({}{}{})", path_, card_, bus_.empty() ? "" : ", ", bus_);
}

std::string VideoDevice::form() const {
  const char* stamp = !any_      ? ""
                      : !stamps_ ? ", stamped when read"
                      : begins_  ? ", stamped at the beginning of the exposure"
                                 : ", stamped at the end of the frame";
  return fmt::format("{} {} x {} px{}{}", word_of(raster_.pixels), raster_.width, raster_.height,
                     rate_ > 0.0 ? fmt::format(" at {:.4g} Hz", rate_) : "", stamp);
}

}  // namespace enc::v4l2
