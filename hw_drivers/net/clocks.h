// The clocks of the drivers, of the loop and of a device, and how they are related.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "core/base/frames.h"
#include "core/base/time.h"

namespace enc::net {

// The clock of the drivers: measures ages and late answers. It does not give experiment time, which each
// read() and poll() receives.
[[nodiscard]] Duration steady_now() noexcept;  // any start, common to all threads
// Stops steady_now() at this time, so that a test has drivers with threads in virtual time; 0: it runs.
void stand_at(Duration time) noexcept;

// Converts arrival times to the loop's clock within a tick. If the process was stopped, a tick reads data
// that came long after its begin; with the time of the tick, such data would seem to arrive before they were
// sent.
class Arrival {
 public:
  // keeps_wall_time: the loop's clock follows wall time. Otherwise no data come later than their tick.
  explicit Arrival(bool keeps_wall_time) : follows_(keeps_wall_time) {}

  // Call in each tick, before of(). now: time of the tick; steady: steady_now().
  void begin(Time now, Duration steady) noexcept {
    least_ = std::min(least_, steady.count() - now.time_since_epoch().count());
  }
  // Time by the loop's clock for a time by steady_now().
  [[nodiscard]] Time of(Time now, Duration steady) const noexcept {
    return follows_ ? Time(Duration(steady.count() - least_)) : now;
  }

 private:
  bool follows_;
  std::int64_t least_ = std::numeric_limits<std::int64_t>::max();  // ns, between the two clocks
};

// Relates the clock of a device to the loop's, using only the device's stamps and their arrival times. It is
// the only place where the two clocks meet. The quickest messages took a given time. The lower bound line of
// all messages of the last half minute gives offset and drift of the device's clock; messages above it were
// late.
//
// A lasting delay is not a clock error: the line rises by 200 ppm at most, the relative drift of two poor
// crystals. The estimate follows a forward step of the clock at once, because no message arrives before it is
// sent. It counts as a step if it exceeds 20 ms plus 200 ppm of the observed time. A backward step looks like
// a delay, and makes its stamps too old: a caller that sees stamps go back must call forget().

// The device's clock against the loop's: it is `ahead` of the loop's time, and gains `drift` each second.
struct ClockEstimate {
  double ahead = kUnset;     // s, now
  double drift = kUnset;     // s/s; unset: observed for too short a time
  double spread = kUnset;    // s: median height of each half second's quickest message above the line
  std::int64_t forward = 0;  // number of forward steps
};

// "its clock is 3.0000 s ahead of the run's, 50.0 ppm fast; half of its quickest messages lie within 0.020 ms
// of that"; empty: no estimate.
[[nodiscard]] std::string words(const ClockEstimate& clock);

class ClockTie {
 public:
  explicit ClockTie(Duration least) : least_(least) {}  // travel time of the quickest message

  void forget() noexcept;  // call this when stamps went back: the device's clock has changed
  // Time of a stamp by the loop's clock; the stamped message has arrived by now.
  [[nodiscard]] Time here(std::int64_t stamp_ns, Time now) noexcept;
  [[nodiscard]] ClockEstimate estimate() const noexcept;

 private:
  static constexpr std::size_t kBins = 64;
  struct QuickestPacket {
    double stamp = 0.0, gap = 0.0;  // ns since the first: stamp; arrival - stamp
  };
  // The line at a stamp, ns since the first.
  [[nodiscard]] double line(double stamp) const noexcept { return level_ + slope_ * (stamp - from_); }
  void close_bin() noexcept;
  struct PacketWindow {
    std::array<QuickestPacket, kBins> bins{};
    std::size_t count = 0;
  };
  [[nodiscard]] PacketWindow kept() const noexcept;
  [[nodiscard]] static double steepness(const PacketWindow& bins, double mean) noexcept;
  void fit() noexcept;
  [[nodiscard]] const QuickestPacket& bin(std::size_t i) const noexcept { return bins_[i % kBins]; }

  Duration least_;
  bool any_ = false;
  std::int64_t first_stamp_ = 0, first_gap_ = 0;
  std::int64_t forward_ = 0;
  QuickestPacket open_;               // quickest message of the bin being filled
  double opened_ = 0.0, last_ = 0.0;  // stamps
  std::array<QuickestPacket, kBins> bins_{};
  std::size_t begin_ = 0, end_ = 0;  // range of the valid bins, counted without wrapping
  double level_ = 0.0, slope_ = 0.0, from_ = 0.0;
  double lowest_ = 0.0;  // ns at from_: lowest possible level of the clocks by now, from all messages
};

}  // namespace enc::net
