// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::fingertip {
namespace {

const Mutants kMutants{
    "fingertip",
    {{.what = "judged beside the hand; a hand in the empty room; a finger a tenth wider; the work ten times",
      .changes = {"beside", "waves", "wider", "ten_times"},
      .kills = {"tip.640.error.median", "empty.mistaken.count", "radius.power", "outline.off.max",
                "disparity.gross.count", "place.at_600.rms", "ratio_to_opencv.median"}},
     {.what = "rig's hue of skin 20 deg off and half as wide",
      .set = {"rig.vision.skin_hue_deg=36", "rig.vision.skin_spread_deg=2.2"},
      .kills = {"tip.640.found.percent", "candidates.several.percent", "candidates.best.percent",
                "printed.*.found.percent", "race.seen.percent"}}}};

}  // namespace
}  // namespace enc::bench::fingertip
