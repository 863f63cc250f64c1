// Paced wraps any clock and makes it keep wall time, at a factor. It changes when a tick happens, never what
// it is.
#pragma once

#include <cstdint>
#include <memory>

#include "core/devices/clock.h"

namespace enc::sim {

class Paced : public Clock {
 public:
  // factor: seconds of experiment for each second of wall time; must be positive.
  Paced(std::unique_ptr<Clock> clock, double factor) : clock_(std::move(clock)), factor_(factor) {}
  Tick next() override;
  [[nodiscard]] std::int64_t missed() const noexcept override { return clock_->missed(); }

 private:
  std::unique_ptr<Clock> clock_;
  double factor_;
  bool started_ = false;
  std::int64_t start_ns_ = 0;  // wall clock at the first tick
  Time first_{};
};

}  // namespace enc::sim
