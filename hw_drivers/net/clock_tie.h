// Ties the clock of a device to the loop's: what came quickest was under way for a time that is known. The
// last five seconds count, so that a drift of the clocks does no harm; what comes later than any drift tells
// is late, and stays so.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "core/time.h"

namespace enc::net {

class ClockTie {
 public:
  explicit ClockTie(Duration least) : least_(least) {}  // under way, of the quickest

  void forget() noexcept { *this = ClockTie(least_); }  // the device's clock is another now
  // When it was by the loop's clock, of what the device stamped and has come by now.
  [[nodiscard]] Time here(std::int64_t stamp_ns, Time now) noexcept {
    if (shortest_[0] == kNone || now - since_ > kSpan) {
      if (shortest_[0] != kNone) most_ = shortest() + drift(now - since_);
      shortest_[1] = shortest_[0];
      shortest_[0] = kNone;
      since_ = now;
    }
    shortest_[0] = std::min(shortest_[0], now.time_since_epoch().count() - stamp_ns);
    return Time(Duration(stamp_ns + shortest())) - least_;
  }

 private:
  static constexpr Duration kSpan{2'500'000'000};
  static constexpr std::int64_t kDriftPpm = 200;  // of two clocks at most: two bad crystals
  [[nodiscard]] static std::int64_t drift(Duration in) noexcept { return in.count() / 1'000'000 * kDriftPpm; }
  [[nodiscard]] std::int64_t shortest() const noexcept {
    return std::min({shortest_[0], shortest_[1], most_});
  }
  static constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();
  Duration least_;
  Time since_{};
  std::array<std::int64_t, 2> shortest_{kNone, kNone};  // arrival - stamp, ns: of this span and of the last
  std::int64_t most_ = kNone;                           // likewise: what a drift makes of the one before
};

}  // namespace enc::net
