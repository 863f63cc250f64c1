#include "hw_drivers/netft/drive/session.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace enc::netft {

// ---- the rate of the box's counter

namespace {

// Rates of a Net Box and of the ADC of an Axia: 3906.25 Hz times powers of two (its manual, 9620-05-C, table
// 5.5, gives them rounded).
constexpr std::array<double, 6> kRates{kNetBoxRate, 488.28125, 976.5625, 1953.125, 3906.25, 7812.5};
// Tolerance to a known rate, as a share of it. A quartz is within 0.0001. The quickest records of 0.4 s give
// the rate to some 0.001 on a busy network, and those of 3 s give it more precisely.
constexpr double kWithin = 0.003;
constexpr std::size_t kFewest = 20;

}  // namespace

void CounterRate::take(std::uint32_t sample, Duration came) {
  if (seen_.empty()) first_ = came;
  const auto ahead = static_cast<std::int32_t>(sample - last_);
  const double at = seconds(came - first_);
  if (!seen_.empty() && (ahead < 0 || at < seen_.back().came)) return;
  seen_.push_back({seen_.empty() ? 0.0 : seen_.back().sample + ahead, at});
  last_ = sample;
}

double CounterRate::watched() const noexcept { return seen_.empty() ? 0.0 : seen_.back().came; }

// A record may be late but never early. So the quickest records of the first and of the last quarter give the
// rate. Which records are the quickest depends on the rate, so the search repeats with each better rate.
double CounterRate::measured() const noexcept {
  if (seen_.size() < kFewest || !(watched() > 0.0)) return kUnset;
  double rate = seen_.back().sample / watched();
  const auto quarter = static_cast<std::ptrdiff_t>(seen_.size() / 4);
  constexpr int kTurns = 3;
  for (int turn = 0; turn < kTurns && rate > 0.0; ++turn) {
    const auto quicker = [rate](const SampleArrival& a, const SampleArrival& b) {
      return a.came - a.sample / rate < b.came - b.sample / rate;
    };
    const SampleArrival& early = *std::min_element(seen_.begin(), seen_.begin() + quarter, quicker);
    const SampleArrival& late = *std::min_element(seen_.end() - quarter, seen_.end(), quicker);
    if (late.came > early.came) rate = (late.sample - early.sample) / (late.came - early.came);
  }
  return rate;
}

double CounterRate::known() const noexcept {
  const double rate = measured();
  const auto is = [rate](double one) { return std::abs(rate - one) <= kWithin * one; };
  if (set_ > 0.0) return is(set_) ? set_ : kUnset;
  const auto* const found = std::find_if(kRates.begin(), kRates.end(), is);
  return found == kRates.end() ? kUnset : *found;
}

std::string grouped(double rate) {
  if (std::isnan(rate)) return "0";
  std::string text = fmt::format("{:.0f}", rate);
  for (std::size_t at = text.size(); at > 3;) text.insert(at -= 3, ",");
  return text;
}

// ---- records

namespace {

constexpr std::int32_t kMost = 70'000;  // samples between two records: ten seconds

// Difference of two counter values; the sample counter wraps around.
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
  tie_.forget();  // another box, or this one was restarted
  begun_anew_ = true;
  number_ = record.number;
  return true;
}

// Beyond its rating a transducer is not linear, and its calibration is not valid.
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
  // A record that comes 10 ms late changes the rate over this time by 0.03 %.
  constexpr double kLeast = 30.0;
  const double lasts = begun_ ? age(last_, since_) : 0.0;
  return lasts >= kLeast ? static_cast<double>(samples_ - since_samples_) / lasts : kUnset;
}

}  // namespace enc::netft
