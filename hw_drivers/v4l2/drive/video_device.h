// One video device of V4L2: it negotiates the format, shares the kernel's buffers, and takes frames.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/time.h"
#include "hw_drivers/v4l2/wire/pixels.h"
#include "hw_drivers/v4l2/wire/system.h"

namespace enc::v4l2 {

// The format that a rig needs.
struct StreamRequest {
  Pixels pixels = Pixels::yuyv;
  int width = 0, height = 0;  // px, of the device
  double rate = 20.0;         // Hz
  int buffers = 4;
};

// A frame's bytes, copied out of the kernel's buffer; the memory is reused.
struct RawFrame {
  std::vector<std::uint8_t> bytes;
  std::size_t used = 0;
  Duration stamp{};  // CLOCK_MONOTONIC
  [[nodiscard]] std::span<const std::uint8_t> view() const { return std::span(bytes).first(used); }
};

class VideoDevice {
 public:
  // Opens the device and begins to stream. Throws Error (kind device) with the path and a remedy.
  VideoDevice(System& system, const std::string& path, const StreamRequest& wanted);
  ~VideoDevice();
  VideoDevice(const VideoDevice&) = delete;
  VideoDevice& operator=(const VideoDevice&) = delete;

  enum class TakeResult : std::uint8_t { frame, damaged, nothing, gone };
  // The oldest frame that waits. gone: the device was unplugged, or its driver gave up.
  [[nodiscard]] TakeResult take(RawFrame& into) noexcept;

  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] const Raster& raster() const { return raster_; }
  [[nodiscard]] std::size_t frame_bytes() const { return frame_bytes_; }
  [[nodiscard]] std::int64_t lost() const { return lost_; }  // frames, by gaps of the sequence
  [[nodiscard]] const std::string& card() const { return card_; }
  // "/dev/video0 (CARD, BUS)", and the format with the kind of stamp, which is known from the first frame on.
  [[nodiscard]] std::string name() const;
  [[nodiscard]] std::string form() const;
  // False: the kernel does not stamp this device's frames with CLOCK_MONOTONIC. The time of reading stands
  // instead. Known from the first frame on.
  [[nodiscard]] bool stamps() const { return stamps_; }

 private:
  struct SharedBuffer {
    std::uint8_t* memory = nullptr;
    std::size_t size = 0;
  };
  void open();
  void close() noexcept;
  void identify();
  void set_format(const StreamRequest& wanted);
  void set_rate(const StreamRequest& wanted);
  void share_buffers(const StreamRequest& wanted);
  void begin();
  [[nodiscard]] bool queue(std::uint32_t index) noexcept;

  System& system_;
  std::string path_;
  int descriptor_ = -1;
  std::string card_, bus_;
  Raster raster_;
  std::size_t frame_bytes_ = 0;
  double rate_ = 0.0;  // Hz; 0: the device does not report it
  std::vector<SharedBuffer> buffers_;
  bool streams_ = false, any_ = false, stamps_ = true, begins_ = false;
  std::uint32_t sequence_ = 0;
  std::int64_t lost_ = 0;
};

}  // namespace enc::v4l2
