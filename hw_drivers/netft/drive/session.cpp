#include "hw_drivers/netft/drive/session.h"

#include <algorithm>
#include <cmath>

namespace enc::netft {

void Session::take(std::span<const std::byte> datagram, Time now) noexcept {
  Record record;
  if (!read(datagram, record)) {
    ++counts_.wrong;
    return;
  }
  // The counter of samples goes round: what is less than half a round ahead is newer.
  const std::uint32_t ahead = record.sample - sample_;
  if (begun_ && (ahead == 0 || ahead >= 0x80000000U)) {
    ++counts_.old;
    return;
  }
  if (begun_) {
    samples_ += ahead;
    if (record.number > number_) counts_.missing += record.number - number_ - 1;
    counts_.longest_gap = std::max(counts_.longest_gap, age(now, last_));
  }
  begun_ = true;
  sample_ = record.sample;
  number_ = record.number;
  last_ = now;
  ++counts_.records;
  const auto force = [&](std::size_t i) { return record.counts[i] / of_.per_newton; };
  const auto torque = [&](std::size_t i) { return record.counts[i] / of_.per_newton_metre; };
  const Time t =
      lockstep_ ? now : tie_.here(std::llround(1e9 / kSampleRate * static_cast<double>(samples_)), now);
  const Health health = health_of(record.status);
  if (health != Health::ok) counts_.status = record.status;
  newest_ = {{Vec<'F'>(force(0), force(1), force(2)), Vec<'F'>(torque(3), torque(4), torque(5))},
             std::max(t, newest_.t),
             health};
}

}  // namespace enc::netft
