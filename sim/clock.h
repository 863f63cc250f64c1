// Paced wraps any clock and makes it keep wall time, at a factor.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "core/devices/clock.h"

namespace enc::sim {

// What becomes of cycles that the wall clock has passed by: the process was stopped, or the machine is busy.
// Neither makes them up in a burst.
enum class Late : std::uint8_t {
  wait,  // nothing is lost: experiment time goes on where it was, later. For what is simulated alone: a tick
         // happens at another moment and is the same
  skip   // they are lost, and missed() says how many: experiment time is that of the devices (sources/choices
         // 6). What is simulated beside them follows
};

class Paced final : public Clock {
 public:
  // factor: seconds of experiment for each second of wall time; must be positive. `stopped`: asked while it
  // waits, at least 20 times a second; then next() comes back early.
  Paced(std::unique_ptr<Clock> clock, double factor, Late late, std::function<bool()> stopped = {})
      : clock_(std::move(clock)), factor_(factor), late_(late), stopped_(std::move(stopped)) {}
  Tick next() override;
  // Cycles that were skipped before the last tick; a clock that waits skips none.
  [[nodiscard]] std::int64_t missed() const noexcept override { return missed_; }
  [[nodiscard]] Lateness lateness() const noexcept override { return lateness_; }

 private:
  void wait_until(std::int64_t due_ns);

  std::unique_ptr<Clock> clock_;
  double factor_;
  Late late_;
  std::function<bool()> stopped_;
  bool started_ = false;
  std::int64_t start_ns_ = 0;  // wall clock at the first tick, later by what was waited for
  Time first_{};
  std::int64_t missed_ = 0;
  Lateness lateness_;
};

}  // namespace enc::sim
