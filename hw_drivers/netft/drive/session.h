// Evaluates records: which are new, their forces and their times, and at what rate the box counts. It uses
// neither sockets nor clocks.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "core/base/time.h"
#include "hw_drivers/net/clocks.h"
#include "hw_drivers/netft/wire/messages.h"
#include "hw_drivers/netft/wire/page.h"

namespace enc::netft {

// Measures the rate of a box's sample counter. The box stamps its records with that counter, and its HTTP
// page does not state the rate. The measurement compares counter and arrival times before a run begins.

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
  struct SampleArrival {
    double sample = 0.0;  // since the first
    double came = 0.0;    // s, since the first
  };
  double set_;
  std::uint32_t last_ = 0;
  Duration first_{};
  std::vector<SampleArrival> seen_;
};

// "7,000"
[[nodiscard]] std::string grouped(double rate);

struct Counts {
  std::int64_t records = 0;
  std::int64_t missing = 0;  // numbers that never came, or came too late
  std::int64_t old = 0;      // arrived after a newer one, or twice
  std::int64_t wrong = 0;    // not a record
  std::int64_t beyond = 0;   // force or torque beyond the rating of its axis (cfgmr)
  std::uint32_t status = 0;  // last fault or saturation
  double longest_gap = 0.0;  // s, between two records
};

class Session {
 public:
  // counter_rate: rate of the box's own sample counter, Hz. In lockstep a record has the time of its arrival.
  Session(const Configuration& of, Duration least_delay, bool lockstep, double counter_rate = kNetBoxRate)
      : of_(of), tie_(least_delay), counter_rate_(counter_rate), lockstep_(lockstep) {}

  // A record has no checksum. A record whose counter is far from the expected value counts only if the next
  // one continues from there, as after a restart of the box.
  void take(std::span<const std::byte> datagram, Time now) noexcept;
  // absent before the first record
  [[nodiscard]] const Measurement<Wrench>& newest() const noexcept { return newest_; }
  [[nodiscard]] net::ClockEstimate clock() const noexcept {
    return tie_.estimate();
  }  // 0 at its first record
  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }
  // Counter rate by arrival since the first record, Hz; unset below half a minute, because a late record
  // would still matter.
  [[nodiscard]] double counted() const noexcept;

 private:
  Configuration of_;
  net::ClockTie tie_;
  double counter_rate_;
  bool lockstep_, begun_ = false, begun_anew_ = false;
  Counts counts_;
  [[nodiscard]] bool within_rating(const Record& record) const noexcept;
  [[nodiscard]] bool believed(const Record& record) noexcept;  // counts a refused one

  std::uint32_t number_ = 0, sample_ = 0;
  std::uint32_t far_sample_ = 0;  // counter of the last record that was far off
  bool was_far_ = false;
  std::int64_t samples_ = 0;  // since the first, without wrapping
  // Samples and time of the first record, or of the first one after a restart of the box.
  std::int64_t since_samples_ = 0;
  Time since_{};
  Measurement<Wrench> newest_;
  Time last_{};  // arrival of the last record
};

}  // namespace enc::netft
