// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::segmentation {
namespace {

const Mutants kMutants{
    "segmentation",
    {{.what = "rig's hue of skin 20 deg off and half as wide; the work ten times; two bins",
      .set = {"rig.vision.skin_hue_deg=36", "rig.vision.skin_spread_deg=2.2"},
      .changes = {"ten_times", "two_bins"},
      .kills = {"skin.*.*", "published.correct.mean", "published.false_negatives.mean", "published.iou.mean",
                "ours.correct.mean", "ours.false_negatives.mean", "ours.iou.mean", "*.ours.*.mean",
                "race.wrong.mean", "ratio_to_mog2.median", "median.*.median", "tiles.*.median",
                "tiles.unlike.mean"}},
     {.what = "every hue is skin; every tile and each pixel has changed; a wider median",
      .set = {"rig.vision.skin_sigmas=100", "rig.vision.match=1", "rig.vision.change_sigmas=0.1"},
      .changes = {"wider_median"},
      .kills = {"published.false_positives.mean", "ours.false_positives.mean", "median.unlike.count"}}}};

}  // namespace
}  // namespace enc::bench::segmentation
