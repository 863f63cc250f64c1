// PacedClock wraps any clock and makes it follow wall time, at a factor.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "core/devices/rig.h"

namespace enc::sim {

// Treatment of cycles that the wall clock has passed, because the process was stopped or the machine is busy.
// Neither mode makes them up in a burst.
enum class LatePolicy : std::uint8_t {
  // Loses no cycle: experiment time continues later where it was. Only for pure simulations: a tick happens
  // at another moment, but is unchanged.
  wait,
  // Loses the cycles, and missed() reports their number: experiment time is that of the devices
  // (sources/choices 6). Simulated devices beside them follow.
  skip
};

class PacedClock final : public Clock {
 public:
  // factor: seconds of experiment for each second of wall time; must be positive. `stopped`: called during
  // waits, at least 20 times a second; if true, next() returns early.
  PacedClock(std::unique_ptr<Clock> clock, double factor, LatePolicy late, std::function<bool()> stopped = {})
      : clock_(std::move(clock)), factor_(factor), late_(late), stopped_(std::move(stopped)) {}
  Tick next() override;
  // Cycles skipped before the last tick; a clock that waits skips none.
  [[nodiscard]] std::int64_t missed() const noexcept override { return missed_; }
  [[nodiscard]] Lateness lateness() const noexcept override { return lateness_; }

 private:
  void wait_until(std::int64_t due_ns);

  std::unique_ptr<Clock> clock_;
  double factor_;
  LatePolicy late_;
  std::function<bool()> stopped_;
  bool started_ = false;
  std::int64_t start_ns_ = 0;  // wall clock at the first tick, plus the time waited
  Time first_{};
  std::int64_t missed_ = 0;
  Lateness lateness_;
};

}  // namespace enc::sim
