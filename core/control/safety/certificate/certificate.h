// Whether a device renders a stiffness stably, and by which bound: the certificate of one loop, in all
// directions that the tip moves in.
//
// What "stable" means depends on the disturbance, because friction and encoder steps do: dry friction takes
// most of a small swing's energy and little of a large one's. The classes, the first that is so:
//
//   passive         it gives out no energy, whatever holds it: the whole theorem of Colgate and Schenkel for
//                   this law and delay, and no more of a count's force than friction holds,
//                   (K + 2 |B|/(nT)) step <= 2 f_c
//   stable alone    every eigenvalue of the sampled loop is within the unit circle where nobody touches it,
//                   and with the hand rigidly on it: any disturbance dies out, until counts and friction are
//                   all that is left
//   held            with the hand, and not without
//   unheld          without the hand, and not with it: beyond the bound with a hand
//   locally stable  linearly unstable with the hand and without, but there is friction, and it stops what is
//                   small: let go 0.1 mm beside its target it comes to rest (release.h). Of 1 mm `large`
//                   tells
//   unstable        none of these
//   unknown         a figure is missing, or is none that can be, or the release that would tell is too slow
//   to
//                   be simulated: `missing` names it
//
// `small` and `large` say for every class what becomes of 0.1 mm and of 1 mm, without a hand, with friction
// and counts: "stable at that disturbance" is `still` there, whatever the class. A loop that is stable alone
// and yet cycles there hunts: its counts push more than its friction holds. The release runs along the normal
// alone: both are `unknown` if the eigenvalues of all directions say something else than those of the normal.
#pragma once

#include <string>

#include "core/control/safety/certificate/release.h"

namespace enc::certificate {

enum class Class : std::uint8_t { passive, alone, held, unheld, local, unstable, unknown };
constexpr auto words(Class) {
  return enum_words("passive", "stable alone", "stable with a hand on it", "stable alone, not with this hand",
                    "locally stable", "unstable", "unknown");
}

struct Certificate {
  Class verdict = Class::unknown;
  std::string missing;    // of an unknown one: the figure, and what is wrong with it where that is not plain
  std::vector<Row> rows;  // bounds.h; also of an unknown one, NaN where they are not known
  Plane plane{};
  Released small{}, large{};  // let go 0.1 mm and 1 mm beside the target
};

// `loop.hand`: the hand that is on it, where one is. No figure of the loop may be missing but its filter.
[[nodiscard]] Certificate certify(const SampledLoop& loop, const Steps& steps, const Asked& asked);

// The class alone, where one look tells: a fiftieth of the time. `unknown` where a figure is missing, and
// where it is not stable, neither alone nor held: there friction decides.
[[nodiscard]] Class linear_class(const SampledLoop& loop, const Steps& steps, const Asked& asked);

// The row of that name; throws std::out_of_range where there is none.
[[nodiscard]] const Row& row_of(const Certificate& certificate, const std::string& name);

}  // namespace enc::certificate
