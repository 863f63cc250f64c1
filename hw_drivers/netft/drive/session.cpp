#include "hw_drivers/netft/drive/session.h"

#include <algorithm>
#include <cmath>

namespace enc::netft {
namespace {

constexpr std::int32_t kMost = 70'000;  // samples from one record to the next: ten seconds

// The counter of samples goes round.
std::int32_t ahead(std::uint32_t sample, std::uint32_t of) noexcept {
  return static_cast<std::int32_t>(sample - of);
}

}  // namespace

bool Session::believed(const Record& record) noexcept {
  const std::int32_t by = ahead(record.sample, sample_);
  if (!begun_ || (by > 0 && by <= kMost)) {
    samples_ += begun_ ? by : 0;
    return true;
  }
  if (by <= 0 && by > -kMost) {
    ++counts_.old;
    return false;
  }
  const std::int32_t on = ahead(record.sample, far_sample_);
  const bool goes_on = was_far_ && on > 0 && on <= kMost;
  was_far_ = true;
  far_sample_ = record.sample;
  if (!goes_on) {
    ++counts_.wrong;
    return false;
  }
  tie_.forget();  // another box, or this one began anew
  begun_anew_ = true;
  number_ = record.number;
  return true;
}

// Beyond its rating a transducer is not linear, and nothing of its calibration holds.
bool Session::within_rating(const Record& record) const noexcept {
  for (std::size_t i = 0; i < kAxes; ++i)
    if (std::abs(record.counts[i] / (i < 3 ? of_.per_newton : of_.per_newton_metre)) > of_.ratings[i])
      return false;
  return true;
}

void Session::take(std::span<const std::byte> datagram, Time now) noexcept {
  Record record;
  if (!read(datagram, record)) {
    ++counts_.wrong;
    return;
  }
  if (!believed(record)) return;
  was_far_ = false;
  if (begun_) {
    if (record.number > number_) counts_.missing += record.number - number_ - 1;
    counts_.longest_gap = std::max(counts_.longest_gap, age(now, last_));
  }
  if (!begun_ || begun_anew_) since_ = now, since_samples_ = samples_;
  begun_ = true, begun_anew_ = false;
  sample_ = record.sample;
  number_ = record.number;
  last_ = now;
  ++counts_.records;
  const auto force = [&](std::size_t i) { return record.counts[i] / of_.per_newton; };
  const auto torque = [&](std::size_t i) { return record.counts[i] / of_.per_newton_metre; };
  const Time t =
      lockstep_ ? now : tie_.here(std::llround(1e9 / counter_rate_ * static_cast<double>(samples_)), now);
  Health health = health_of(record.status);
  if (health != Health::ok) counts_.status = record.status;
  if (!within_rating(record)) {
    ++counts_.beyond;
    if (health == Health::ok) health = Health::saturated;
  }
  newest_ = {{Vec<'F'>(force(0), force(1), force(2)), Vec<'F'>(torque(3), torque(4), torque(5))},
             std::max(t, newest_.t),
             health};
}

double Session::counted() const noexcept {
  // One record that came 10 ms late changes the rate of so many seconds by 0.03 %.
  constexpr double kLeast = 30.0;
  const double lasts = begun_ ? age(last_, since_) : 0.0;
  return lasts >= kLeast ? static_cast<double>(samples_ - since_samples_) / lasts : kUnset;
}

}  // namespace enc::netft
