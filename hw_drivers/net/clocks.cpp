#include "hw_drivers/net/clocks.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace enc::net {

namespace {

std::atomic<Duration::rep> stands_at = 0;

}  // namespace

void stand_at(Duration time) noexcept { stands_at = time.count(); }

Duration steady_now() noexcept {
  if (const Duration::rep time = stands_at.load(std::memory_order_acquire); time != 0) return Duration(time);
  return std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch());
}

namespace {

constexpr double kBin = 0.5e9;  // ns, width of a bin
constexpr double kSpan = 32e9;  // ns, length of the valid history
constexpr double kSteepest =
    200e-6;                    // s/s, two crystals, each wrong by 100 ppm; no slewing (500 ppm) during a run
constexpr double kSet = 20e6;  // ns: no delay is so much shorter than the shortest earlier one
constexpr std::size_t kFewest = 10;  // bins, for a drift: after five seconds 1 ms of jitter leaves some 6 ppm

}  // namespace

void ClockTie::forget() noexcept {
  const std::int64_t forward = forward_;
  *this = ClockTie(least_);
  forward_ = forward;
}

Time ClockTie::here(std::int64_t stamp_ns, Time now) noexcept {
  const std::int64_t gap_ns = now.time_since_epoch().count() - stamp_ns;
  if (any_) {
    const auto since = static_cast<double>(stamp_ns - first_stamp_) - from_;
    const bool forward = end_ - begin_ > 1 && static_cast<double>(gap_ns - first_gap_) <
                                                  lowest_ - kSteepest * std::max(since, 0.0) - kSet;
    if (forward) {
      ++forward_;
      forget();
    }
  }
  if (!any_) {
    any_ = true;
    first_stamp_ = stamp_ns;
    first_gap_ = gap_ns;
    open_ = {0.0, std::numeric_limits<double>::infinity()};
  }
  const auto stamp = static_cast<double>(stamp_ns - first_stamp_),
             gap = static_cast<double>(gap_ns - first_gap_);
  last_ = std::max(last_, stamp);
  if (stamp - opened_ >= kBin) {
    close_bin();
    opened_ = stamp;
    open_ = {stamp, gap};
  }
  if (gap < open_.gap) open_ = {stamp, gap};
  const double above = gap - line(stamp);
  if (above < 0.0) level_ += above;  // no message lies below the line
  return Time(Duration(stamp_ns + first_gap_ + static_cast<std::int64_t>(line(stamp)))) - least_;
}

void ClockTie::close_bin() noexcept {
  bins_[end_++ % kBins] = open_;
  while (end_ - begin_ > kBins || open_.stamp - bin(begin_).stamp > kSpan) ++begin_;
  fit();
}

// Excludes bins that lie too far above a later one: no clock falls that steeply. Such messages were late, or
// the clock was set forward since. The lower bound line never touches them.
ClockTie::PacketWindow ClockTie::kept() const noexcept {
  PacketWindow of;
  double ceiling = std::numeric_limits<double>::infinity();  // limit for gap + kSteepest * stamp
  for (std::size_t i = end_; i > begin_; --i) {
    const QuickestPacket& one = bin(i - 1);
    const double height = one.gap + kSteepest * one.stamp;
    if (height > ceiling) continue;
    ceiling = height;
    of.bins[of.count++] = one;
  }
  std::reverse(of.bins.begin(), of.bins.begin() + static_cast<std::ptrdiff_t>(of.count));
  return of;
}

// Slope of the closest line below all points, the one highest above their mean. It is an edge of their lower
// hull, limited to the steepest clock drift.
double ClockTie::steepness(const PacketWindow& bins, double mean) noexcept {
  std::array<QuickestPacket, kBins> hull{};
  std::size_t size = 0;
  for (std::size_t i = 0; i < bins.count; ++i) {
    const QuickestPacket& next = bins.bins[i];
    if (size > 0 && next.stamp <= hull[size - 1].stamp) continue;
    const auto over = [&](const QuickestPacket& a,
                          const QuickestPacket& b) {  // b lies on or above the line a-next
      return (b.gap - a.gap) * (next.stamp - a.stamp) >= (next.gap - a.gap) * (b.stamp - a.stamp);
    };
    while (size > 1 && over(hull[size - 2], hull[size - 1])) --size;
    hull[size++] = next;
  }
  std::size_t edge = 0;
  while (edge + 2 < size && hull[edge + 1].stamp < mean) ++edge;
  if (size < 2) return 0.0;
  const QuickestPacket &a = hull[edge], &b = hull[edge + 1];
  return std::clamp((b.gap - a.gap) / (b.stamp - a.stamp), -kSteepest, kSteepest);
}

// A known drift stays valid while there are too few bins for a new one.
void ClockTie::fit() noexcept {
  const PacketWindow of = kept();
  double mean = 0.0;
  for (std::size_t i = 0; i < of.count; ++i) mean += of.bins[i].stamp / static_cast<double>(of.count);
  const double slope = of.count < kFewest ? slope_ : steepness(of, mean);
  const double now = open_.stamp;
  double level = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < of.count; ++i)
    level = std::min(level, of.bins[i].gap - slope * (of.bins[i].stamp - now));
  const double parted = level_ + kSteepest * (now - from_);  // highest level that the clocks' drift allows
  level_ = std::min(level, parted);
  slope_ = slope;
  lowest_ = end_ > 1 ? std::min(lowest_ - kSteepest * (now - from_), level_) : level_;
  from_ = now;
}

ClockEstimate ClockTie::estimate() const noexcept {
  ClockEstimate of;
  of.forward = forward_;
  if (!any_) return of;
  of.ahead = -1e-9 * (static_cast<double>(first_gap_) + line(last_)) + seconds(least_);
  const PacketWindow bins = kept();
  if (bins.count < kFewest) return of;
  of.drift = -slope_;
  std::array<double, kBins> above{};
  for (std::size_t i = 0; i < bins.count; ++i)
    above[i] = 1e-9 * (bins.bins[i].gap - line(bins.bins[i].stamp));
  const auto middle = above.begin() + static_cast<std::ptrdiff_t>(bins.count / 2);
  std::nth_element(above.begin(), middle, above.begin() + static_cast<std::ptrdiff_t>(bins.count));
  of.spread = *middle;
  return of;
}

std::string words(const ClockEstimate& clock) {
  if (std::isnan(clock.ahead)) return {};
  std::string text = fmt::format("its clock is {:.4f} s {} the run's", std::abs(clock.ahead),
                                 clock.ahead < 0.0 ? "behind" : "ahead of");
  if (!std::isnan(clock.drift))
    text += fmt::format(", {:.1f} ppm {}; half of its quickest messages lie within {:.3f} ms of that",
                        1e6 * std::abs(clock.drift), clock.drift < 0.0 ? "slow" : "fast", 1e3 * clock.spread);
  if (clock.forward > 0) text += fmt::format("; it was set forward {} times", clock.forward);
  return text;
}

}  // namespace enc::net
