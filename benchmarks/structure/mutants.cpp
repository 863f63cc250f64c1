// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::structure {
namespace {

const Mutants kMutants{
    "structure",
    {{.what = "converged path of the other form; legs 2 % stiffer in the formulas; 0.1 N left; twice the "
              "push; a speed that is no number; four times the work; repeatability 1 um",
      .set = {"truth.hexapod.repeatability_um=1"},
      .changes = {"other_form", "stiffer_reference", "weight_left", "double_push", "no_number", "four_times"},
      .kills = {"step_over_yardstick.median", "tick_over_yardstick.mean", "tendon.rk4.*.order",
                "tendon.rk4.500.error.rms", "tendon.*.15.625.order", "tendon.*.7.8125.order", "zero.error",
                "sag.*.50", "mode.*.frequency", "payload.sag", "payload.pushed.sag", "payload.leg_force.max",
                "payload.diverged", "repeatability.rms"}}}};

}  // namespace
}  // namespace enc::bench::structure
