// Ties the clock of a device to the loop's, from nothing but what the device stamped and when it came: the
// one place where the two meet. What came quickest was under way for a time that is given; the line under all
// that came in the last half minute is offset and drift of the device's clock, and what lies above it was
// late.
//
// A delay that lasts is no clock: the line rises by 200 ppm at most, as two poor crystals drift apart. A
// clock that is set forward is followed at once, as nothing comes before it is sent; by more than 20 ms, and
// 200 ppm of the time that it was watched for, it is called so. One that is set back looks like a delay, and
// what it stamps too old: whoever sees stamps go back says so (forget()).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/base/frames.h"
#include "core/base/time.h"

namespace enc::net {

// The device's clock against the loop's: what it says is `ahead` of the loop's time, `drift` more each
// second.
struct ClockEstimate {
  double ahead = kUnset;     // s, now
  double drift = kUnset;     // s/s; unset: watched for too short a time
  double spread = kUnset;    // s: how far the quickest of each half second lie above the line, the median
  std::int64_t forward = 0;  // how often it was set forward
};

// "its clock is 3.0000 s ahead of the run's, 50.0 ppm fast; half of its quickest messages lie within
// 0.020 ms of that"; empty: nothing is known.
[[nodiscard]] std::string words(const ClockEstimate& clock);

class ClockTie {
 public:
  explicit ClockTie(Duration least) : least_(least) {}  // under way, of the quickest

  void forget() noexcept;  // the device's clock is another now: its stamps went back
  // When it was by the loop's clock, of what the device stamped and has come by now.
  [[nodiscard]] Time here(std::int64_t stamp_ns, Time now) noexcept;
  [[nodiscard]] ClockEstimate estimate() const noexcept;

 private:
  static constexpr std::size_t kBins = 64;
  struct Quickest {
    double stamp = 0.0, gap = 0.0;  // ns since the first: of the stamp; arrival - stamp
  };
  // The line at a stamp, ns since the first.
  [[nodiscard]] double line(double stamp) const noexcept { return level_ + slope_ * (stamp - from_); }
  void close_bin() noexcept;
  struct Kept {
    std::array<Quickest, kBins> bins{};
    std::size_t count = 0;
  };
  [[nodiscard]] Kept kept() const noexcept;
  [[nodiscard]] static double steepness(const Kept& bins, double mean) noexcept;
  void fit() noexcept;
  [[nodiscard]] const Quickest& bin(std::size_t i) const noexcept { return bins_[i % kBins]; }

  Duration least_;
  bool any_ = false;
  std::int64_t first_stamp_ = 0, first_gap_ = 0;
  std::int64_t forward_ = 0;
  Quickest open_;                     // of the bin that is filled
  double opened_ = 0.0, last_ = 0.0;  // stamps
  std::array<Quickest, kBins> bins_{};
  std::size_t begin_ = 0, end_ = 0;  // of the bins that count, as if there were no end of them
  double level_ = 0.0, slope_ = 0.0, from_ = 0.0;
  double lowest_ = 0.0;  // ns at from_: as low as the clocks may be by now, of whatever came
};

}  // namespace enc::net
