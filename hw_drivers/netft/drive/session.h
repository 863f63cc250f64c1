// What is made of records: which are news, what they weigh and when they were true. It knows neither sockets
// nor clocks.
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
  std::int64_t old = 0;      // came behind a newer one, or twice
  std::int64_t wrong = 0;    // no record
  std::int64_t beyond = 0;   // with a force or torque beyond the rating of its axis (cfgmr)
  std::uint32_t status = 0;  // the last that was a fault or saturated
  double longest_gap = 0.0;  // between two that came, s
};

class Session {
 public:
  // counter_rate: of the box's own counter of samples, Hz. Lockstep: a record is true when it comes.
  Session(const Configuration& of, Duration least_delay, bool lockstep, double counter_rate = kNetBoxRate)
      : of_(of), tie_(least_delay), counter_rate_(counter_rate), lockstep_(lockstep) {}

  // A record has no checksum: one whose counter is far from what was expected is believed when the next goes
  // on from there, as after a box was switched off and on.
  void take(std::span<const std::byte> datagram, Time now) noexcept;
  // absent before the first record.
  [[nodiscard]] const Stamped<Wrench>& newest() const noexcept { return newest_; }
  [[nodiscard]] net::ClockEstimate clock() const noexcept {
    return tie_.estimate();
  }  // 0 at its first record
  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }
  // Counter over arrival since the first record, Hz; unset below half a minute, in which a late record
  // counts.
  [[nodiscard]] double counted() const noexcept;

 private:
  Configuration of_;
  net::ClockTie tie_;
  double counter_rate_;
  bool lockstep_, begun_ = false, begun_anew_ = false;
  Counts counts_;
  [[nodiscard]] bool within_rating(const Record& record) const noexcept;
  [[nodiscard]] bool believed(const Record& record) noexcept;  // counts it where not

  std::uint32_t number_ = 0, sample_ = 0;
  std::uint32_t far_sample_ = 0;  // of the last that was far
  bool was_far_ = false;
  std::int64_t samples_ = 0;  // since the first, as it never goes round
  // Samples and time of the first record, or of the first after the box began anew.
  std::int64_t since_samples_ = 0;
  Time since_{};
  Stamped<Wrench> newest_;
  Time last_{};  // when a record came
};

}  // namespace enc::netft
