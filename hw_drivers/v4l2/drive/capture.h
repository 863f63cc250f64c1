// Stereo pairs from one or two video devices: capture, pairing and conversion, on the thread of the caller.
// The newest pair wins, and the memory has a fixed size.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "core/base/image.h"
#include "core/base/time.h"
#include "hw_drivers/v4l2/drive/pairs.h"
#include "hw_drivers/v4l2/drive/settings.h"
#include "hw_drivers/v4l2/drive/video_device.h"

namespace enc::v4l2 {

struct StereoPicture {
  Image left, right;
  Duration exposed{};  // the middle of the exposure, CLOCK_MONOTONIC
};

struct CaptureCounts {
  std::int64_t pairs = 0;
  std::int64_t lost = 0;      // frames that the kernel dropped, by their sequence
  std::int64_t damaged = 0;   // frames
  std::int64_t unpaired = 0;  // left frames
  std::int64_t replaced = 0;  // pairs that a newer one overtook
  std::int64_t gone = 0;      // times that a device went away
  PairErrors errors;
};

class Capture {
 public:
  // Opens the devices. Throws Error (kind device). `each`: of one image; `rate` in Hz.
  Capture(System& system, const V4l2Settings& settings, ImageSize each, double rate);

  // Waits for frames, at most this long. True: `into` is a new pair.
  [[nodiscard]] bool turn(Duration most, StereoPicture& into);
  // False: a device went away. Both are then closed.
  [[nodiscard]] bool there() const { return devices_[0] != nullptr; }
  // Opens the devices again, with new stamps. Throws Error (kind device) while one is absent.
  void reopen();
  // Time since the last pair, s; without one, since the devices were opened.
  [[nodiscard]] double silence() const { return seconds(system_.now() - heard_); }

  [[nodiscard]] bool two() const { return !settings_.right.empty(); }
  [[nodiscard]] const CaptureCounts& counts() const { return counts_; }
  [[nodiscard]] std::string describe() const;  // while it is there()
  // The counts in words, for the report; any thread may call it.
  [[nodiscard]] std::string remark(const CaptureCounts& counts) const;
  // The camera is a fake, by its name.
  [[nodiscard]] bool fake() const { return fake_; }

 private:
  static constexpr std::size_t kSlots = Pairs::kHeld + 1;
  struct Side {
    std::array<RawFrame, kSlots> frames;
    std::size_t next = 0;  // free slot
  };
  void open();
  void close();
  void drain(std::size_t side);
  [[nodiscard]] bool newest(ShotPair& pair);
  [[nodiscard]] bool decode(const ShotPair& pair, StereoPicture& into);

  System& system_;
  V4l2Settings settings_;
  ImageSize each_;
  double rate_;
  Pairs pairs_;
  std::array<std::unique_ptr<VideoDevice>, 2> devices_;
  std::array<Side, 2> sides_;
  bool any_ = false;  // one device: its newest frame is `single_`
  Shot single_;
  Decoder decoder_;
  CaptureCounts counts_;
  std::int64_t lost_before_ = 0;  // by devices that are closed
  int damaged_in_a_row_ = 0;
  Duration heard_{};
  bool fake_ = false;
};

}  // namespace enc::v4l2
