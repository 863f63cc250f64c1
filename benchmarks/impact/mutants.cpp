// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::impact {
namespace {

const Mutants kMutants{
    "impact",
    {{.what = "the contact's force for the grip's; law at 500 us; law ten times softer",
      .changes = {"contact_for_grip", "coarse_step", "softer_law"},
      .kills = {"*.felt.error.median", "*.felt.error_N.max", "law.step.error", "law.stiffness.spread"}}}};

}  // namespace
}  // namespace enc::bench::impact
