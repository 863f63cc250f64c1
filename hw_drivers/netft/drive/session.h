// Evaluates records: which are new, their forces and their times. It uses neither sockets nor clocks.
#pragma once

#include <cstdint>
#include <span>

#include "hw_drivers/net/clock_tie.h"
#include "hw_drivers/netft/drive/counter_rate.h"
#include "hw_drivers/netft/wire/configuration.h"
#include "hw_drivers/netft/wire/record.h"

namespace enc::netft {

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
  // counter_rate: of the box's own sample counter, Hz. Lockstep: a record has the time of its arrival.
  Session(const Configuration& of, Duration least_delay, bool lockstep, double counter_rate = kNetBoxRate)
      : of_(of), tie_(least_delay), counter_rate_(counter_rate), lockstep_(lockstep) {}

  // A record has no checksum. A record whose counter is far from the expected value is accepted only when the
  // next one continues from there, as after a restart of the box.
  void take(std::span<const std::byte> datagram, Time now) noexcept;
  // absent before the first record
  [[nodiscard]] const Stamped<Wrench>& newest() const noexcept { return newest_; }
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
  Stamped<Wrench> newest_;
  Time last_{};  // arrival of the last record
};

}  // namespace enc::netft
