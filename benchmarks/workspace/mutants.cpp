// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::workspace {
namespace {

const Mutants kMutants{
    "workspace",
    {{.what = "strokes 20 % longer; tracker's box 1 m wide; a stem without width",
      .set = {"rig.manipulator.geometry.stroke_mm=28", "rig.tracker.volume_mm=[1000,500,300]",
              "rig.manipulator.stem_radius_mm=0.1", "rig.manipulator.gripper_radius_mm=0.1"},
      .kills = {"box.*.extent", "box.volume", "omega6.share", "tracker.farthest.max",
                "below.refused.percent"}}}};

}  // namespace
}  // namespace enc::bench::workspace
