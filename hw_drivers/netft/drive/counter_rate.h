// How fast a box counts its samples: it stamps its records with that counter, and its page does not have the
// rate. Found from what the counter gains while records arrive, before a run begins.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "core/base/time.h"

namespace enc::netft {

inline constexpr double kNetBoxRate = 7000.0;  // of a Net Box, Hz

class CounterRate {
 public:
  // set: the rate as the rig file has it, Hz; 0: that of any box that is known.
  explicit CounterRate(double set = 0.0) : set_(set) {}
  // A record's counter, and when it came. A record that came out of order is left out.
  void take(std::uint32_t sample, Duration came);
  // s, from the first record to the last.
  [[nodiscard]] double watched() const noexcept;
  // Counter over arrival of the records so far, Hz; unset: too few.
  [[nodiscard]] double measured() const noexcept;
  // What it should be, Hz.
  [[nodiscard]] double expected() const noexcept { return set_ > 0.0 ? set_ : kNetBoxRate; }
  // The set rate, or that of a known box, where the measured one is within 0.3 % of it, Hz; else unset. With
  // a wrong rate the age of records would grow without end.
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
