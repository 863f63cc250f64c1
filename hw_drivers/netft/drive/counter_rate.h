// Measures the rate of a box's sample counter. The box stamps its records with that counter, and its HTTP
// page does not state the rate. The measurement compares counter and arrival times before a run begins.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "core/base/time.h"

namespace enc::netft {

inline constexpr double kNetBoxRate = 7000.0;  // rate of a Net Box, Hz

class CounterRate {
 public:
  // set: the rate from the rig file, Hz; 0: that of any known box.
  explicit CounterRate(double set = 0.0) : set_(set) {}
  // Takes a record's counter and arrival time. Ignores a record that arrived out of order.
  void take(std::uint32_t sample, Duration came);
  // s, from the first record to the last.
  [[nodiscard]] double watched() const noexcept;
  // Counter rate by arrival of the records so far, Hz; unset: too few.
  [[nodiscard]] double measured() const noexcept;
  // The expected rate, Hz.
  [[nodiscard]] double expected() const noexcept { return set_ > 0.0 ? set_ : kNetBoxRate; }
  // The set rate, or that of a known box, if the measured one is within 0.3 % of it, Hz; else unset. With a
  // wrong rate the age of records would grow without end.
  [[nodiscard]] double known() const noexcept;

 private:
  struct Seen {
    double sample = 0.0;  // since the first
    double came = 0.0;    // s, since the first
  };
  double set_;
  std::uint32_t last_ = 0;
  Duration first_{};
  std::vector<Seen> seen_;
};

// "7,000"
[[nodiscard]] std::string grouped(double rate);

}  // namespace enc::netft
