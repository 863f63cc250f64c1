#include "hw_drivers/netft/drive/counter_rate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace enc::netft {
namespace {

// A Net Box, and the ADC rates of an Axia: 3906.25 Hz and what halves or doubles it (its manual, 9620-05-C,
// table 5.5, has them rounded).
constexpr std::array<double, 6> kRates{kNetBoxRate, 488.28125, 976.5625, 1953.125, 3906.25, 7812.5};
// The share of a known rate by which a measured one may differ. A quartz is within 0.0001; the quickest
// records of 0.4 s tell the rate to some 0.001 where the network is busy, and those of 3 s yet better.
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

// A record may be late and is never early. So the quickest record of the first quarter and that of the last
// tell the rate; which ones are the quickest depends on the rate, so it is found again with each better rate.
double CounterRate::measured() const noexcept {
  if (seen_.size() < kFewest || !(watched() > 0.0)) return kUnset;
  double rate = seen_.back().sample / watched();
  const auto quarter = static_cast<std::ptrdiff_t>(seen_.size() / 4);
  constexpr int kTurns = 3;
  for (int turn = 0; turn < kTurns && rate > 0.0; ++turn) {
    const auto quicker = [rate](const Seen& a, const Seen& b) {
      return a.came - a.sample / rate < b.came - b.sample / rate;
    };
    const Seen& early = *std::min_element(seen_.begin(), seen_.begin() + quarter, quicker);
    const Seen& late = *std::min_element(seen_.end() - quarter, seen_.end(), quicker);
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

}  // namespace enc::netft
