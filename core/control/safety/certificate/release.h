// Simulated release: a held device is released beside its target, and the simulation finds whether it comes
// to rest. The loop is that of sampled_loop.h plus its nonlinear parts: dry friction and encoder counts.
// Deterministic. Between two changes of the force the device moves exactly; only a hand's spring is
// integrated, in steps that are short for it.
//
// Before its release the device has stood there while the law pushed: every reading, filtered value and
// pending force belongs to that position. The target is at the edge between two counts, the worst place:
// there the law always has something to correct. An encoder reads the middle of its count.
//
// The simulation lasts 100 oscillations, as long as an overdamped loop takes to creep to rest, plus 40
// delays. It runs in quarters, for at most 100,000 periods. If these are fewer than 20 oscillations, a
// release that has not diverged is `unknown`, unless the loop is linear: then the eigenvalues decide.
#pragma once

#include <cstdint>

#include "core/control/safety/certificate/bounds.h"

namespace enc::certificate {

enum class Rest : std::uint8_t {
  // The oscillation is below 1 % of the disturbance in the last quarter, or below 0.9 of the quarter before
  // (still decaying). The second case needs counts that cannot sustain it (holds_counts in bounds.h, or no
  // counts); else the simulation goes on, a quarter more at a time.
  still,
  // It goes on within bounds. Impossible without friction and counts: then the eigenvalues decide.
  cycle,
  // It grows, by more than 1.1 a quarter, or has exceeded 20 times the disturbance.
  away,
  // A figure of the loop, friction or encoder is missing, or the loop is too slow to simulate.
  unknown
};
constexpr auto words(Rest) { return enum_words("still", "limit cycle", "away", "unknown"); }

struct Released {
  Rest rest = Rest::unknown;
  double swing = kUnset;  // m, peak to peak in the last quarter
  double after = kUnset;  // simulated time, s
};
// `disturbance`: m, above 0. The release includes the loop's hand.
[[nodiscard]] Released release(const SampledLoop& loop, const Steps& steps, double stiffness, double damper,
                               double disturbance);

}  // namespace enc::certificate
