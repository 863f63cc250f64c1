// Pairs the frames of two cameras by their stamps. Each frame of the left camera gets the nearest frame of
// the right one. Two cameras that run free drift apart, so the nearest frame changes once a beat.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/time.h"

namespace enc::v4l2 {

struct Shot {
  Duration stamp{};
  std::size_t slot = 0;  // place of its bytes, by the caller
};
struct ShotPair {
  Shot left, right;
  // The mean of both exposures, at which the pair is true.
  [[nodiscard]] Duration stamp() const { return left.stamp + (right.stamp - left.stamp) / 2; }
};

// Differences of the two stamps of each pair, right less left, s.
struct PairErrors {
  std::int64_t pairs = 0;
  double last = 0.0, sum = 0.0, largest = 0.0;  // sum and largest: absolute values
  [[nodiscard]] double mean() const { return pairs > 0 ? sum / static_cast<double>(pairs) : 0.0; }
};

class Pairs {
 public:
  static constexpr std::size_t kHeld = 3;  // newest frames of each side that may still be needed

  // A frame at most half a period away is the nearest one. One that is farther may still have a nearer
  // neighbour, and is taken up to `apart`, once a later one is known.
  Pairs(Duration period, Duration apart) : half_(period / 2), apart_(apart) {}

  void add_left(const Shot& shot) noexcept { unpaired_ += lefts_.add(shot); }
  void add_right(const Shot& shot) noexcept { rights_.add(shot); }
  // The newest pair that is known by now; false: it needs more frames. An older left frame without a pair is
  // dropped.
  [[nodiscard]] bool next(ShotPair& pair) noexcept;
  void forget() noexcept;  // the cameras begin again

  [[nodiscard]] const PairErrors& errors() const { return errors_; }
  [[nodiscard]] std::int64_t unpaired() const { return unpaired_; }  // left frames

 private:
  // The newest frames of a side, oldest first.
  struct FrameQueue {
    std::array<Shot, kHeld> shots{};
    std::size_t count = 0;
    std::int64_t add(const Shot& shot) noexcept;  // number of frames that fell out
    void drop(std::size_t oldest) noexcept;
  };
  [[nodiscard]] std::size_t nearest(Duration stamp) const noexcept;  // of rights_, which is not empty
  void count(const ShotPair& pair) noexcept;

  Duration half_, apart_;
  FrameQueue lefts_, rights_;
  PairErrors errors_;
  std::int64_t unpaired_ = 0;
};

}  // namespace enc::v4l2
