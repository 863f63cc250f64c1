// A held device is let go beside its target: does it come to rest? The sampled loop of sampled_loop.h with
// what is not linear in it: dry friction, and encoders that count. Deterministic. Between two changes of the
// force the device moves exactly, but for a hand's spring, which goes in steps that are short for it.
//
// Before it is let go it has stood there, and the law has pushed all the while: every reading, filtered value
// and force under way is that of the place. The target is at the edge between two counts, the worst place for
// it: there the law never has nothing to do. An encoder reads the middle of its count.
//
// It is watched for 100 swings, as long as a damper takes to creep to rest, and 40 delays, in quarters; but
// for no more than 100,000 periods. Where these are fewer than 20 swings, a release that has not left is
// `unknown`, but where it is linear: there the eigenvalues tell.
#pragma once

#include <cstdint>

#include "core/control/safety/certificate/bounds.h"

namespace enc::certificate {

enum class Rest : std::uint8_t {
  still,  // in the last quarter it swings by less than 1 % of the disturbance; or by less than 0.9 of the
          // quarter before: it is on its way. That only where counts cannot keep it going (holds_counts in
          // bounds.h, or no counts): else it is watched on, a quarter more at a time
  cycle,  // it goes on, bounded; without friction and counts never: then the eigenvalues tell
  away,  // it swings ever wider, by more than 1.1 of the quarter before, or has left 20 times the disturbance
  unknown  // a figure of the loop, friction or encoder is missing, or it is too slow to be simulated
};
constexpr auto words(Rest) { return enum_words("still", "limit cycle", "away", "unknown"); }

struct Released {
  Rest rest = Rest::unknown;
  double swing = kUnset;  // m, from peak to peak in the last quarter
  double after = kUnset;  // s, that it was watched
};
// `disturbance`: m, above 0. With the loop's own hand.
[[nodiscard]] Released release(const SampledLoop& loop, const Steps& steps, double stiffness, double damper,
                               double disturbance);

}  // namespace enc::certificate
