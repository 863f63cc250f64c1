// The certificate of one loop: whether the device renders a stiffness stably, and by which bound, in all
// directions in which the tip moves.
//
// "Stable" depends on the disturbance because of friction and encoder steps: dry friction takes most of the
// energy of a small oscillation and little of a large one. The verdict is the first class that applies:
//
//   passive         The device gives out no energy, whatever holds it: the whole theorem of Colgate and
//                   Schenkel for this law and delay, and friction holds the force of a count,
//                   (K + 2 |B|/(nT)) step <= 2 f_c.
//   stable alone    Every eigenvalue of the sampled loop is within the unit circle, with no contact and with
//                   the hand rigidly attached: any disturbance dies out until only encoder counts and
//                   friction are left.
//   held            Stable with the hand, not without.
//   unheld          Stable without the hand, not with it: beyond the bound with a hand.
//   locally stable  Linearly unstable with the hand and without, but friction stops a small motion: released
//                   0.1 mm beside its target, the tip comes to rest (release()). `large` has the case of 1
//                   mm.
//   unstable        No class above applies.
//   unknown         A figure is missing or impossible, or the deciding release is too slow to simulate;
//                   `missing` names it.
//
// `small` and `large` report for every class how a release from 0.1 mm and from 1 mm ends, without a hand,
// with friction and counts: `still` means stable at that disturbance, whatever the class. A loop that is
// stable alone and yet cycles there hunts: its counts push more than its friction holds. The release runs
// only along the normal, so both are `unknown` if the eigenvalues of all directions contradict those of the
// normal.
#pragma once

#include <cstdint>
#include <string>

#include "core/control/safety/certificate/bounds.h"

namespace enc::certificate {

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

struct ReleaseResult {
  Rest rest = Rest::unknown;
  double swing = kUnset;  // m, peak to peak in the last quarter
  double after = kUnset;  // simulated time, s
};
// `disturbance`: m, above 0. The release includes the loop's hand.
[[nodiscard]] ReleaseResult release(const SampledLoop& loop, const Steps& steps, double stiffness,
                                    double damper, double disturbance);

enum class Class : std::uint8_t { passive, alone, held, unheld, local, unstable, unknown };
constexpr auto words(Class) {
  return enum_words("passive", "stable alone", "stable with a hand on it", "stable alone, not with this hand",
                    "locally stable", "unstable", "unknown");
}

struct Certificate {
  Class verdict = Class::unknown;
  // Class `unknown` only: the missing figure, and the reason if it is not plain.
  std::string missing;
  // Bounds (bounds.h). An unknown class has rows too, NaN for the unknown ones.
  std::vector<Row> rows;
  Plane plane{};
  ReleaseResult small{}, large{};  // released 0.1 mm and 1 mm beside the target
};

// `loop.hand`: the attached hand, if any. Every figure of the loop except its filter is required.
[[nodiscard]] Certificate certify(const SampledLoop& loop, const Steps& steps, const Request& asked);

// The class from the eigenvalues alone, in a fiftieth of the time of certify(). `unknown` if a figure is
// missing, or if the loop is stable neither alone nor held, because friction then decides.
[[nodiscard]] Class linear_class(const SampledLoop& loop, const Steps& steps, const Request& asked);

// The row with that name; throws std::out_of_range if there is no such row.
[[nodiscard]] const Row& row_of(const Certificate& certificate, const std::string& name);

}  // namespace enc::certificate
