// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::plane_button {
namespace {

const Mutants kMutants{
    "plane_button",
    {{.what = "laws 1.1 times as stiff and deep; real arm 6 times as heavy, coarse encoders; tip heavier in "
              "the law; the whole tick for step()",
      .set = {"truth.arm.mass_scale=6", "truth.arm.counts=[60,60,60]"},
      .changes = {"other_law", "heavier_tip", "whole_tick"},
      .kills = {"arm.step_over_yardstick.median", "wall.*.slope", "wall.*.r2", "wall.*.step",
                "button.live.d1", "button.live.d2", "button.live.slope1", "button.live.slope2",
                "button.live.slope3", "button.vision.*", "step.*"}},
     {.what = "a seen finger with 6 mm noise, held; a prop that sticks",
      .set = {"truth.tracker.noise_mm=[6,6,6]", "rig.tracker.prediction=hold"},
      .changes = {"stuck"},
      .kills = {"wall.live.tangential", "wall.vision_alone.r2", "wall.vision_alone.lag"},
      .form = Form::usual},
     {.what = "sudden and gradual change exchanged; a reference wall 1 % stiffer",
      .changes = {"exchange_changes", "stiffer_reference"},
      .kills = {"button.live.*.step", "precision.default"},
      .form = Form::usual}}};

}  // namespace
}  // namespace enc::bench::plane_button
