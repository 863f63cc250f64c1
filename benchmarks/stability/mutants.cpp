// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::stability {
namespace {

const Mutants kMutants{
    "stability",
    {{.what =
          "certificates of ten times the damping and friction; a small damper for the large one; arms 20 ms "
          "late; runs with and without the controller exchanged; soft and firm walls exchanged; hasty "
          "presses",
      .changes = {"ten_times_damped", "damper_of_1", "late_loops", "exchange_control", "soft_for_firm",
                  "stiff_for_soft", "hasty_press"},
      .kills = {"critical.error.max", "gil_hulin.within.max", "damper20.*.*", "*.factor_error.max",
                "regions.*.*", "regions.*.*.*", "maps.agree", "button.agree", "admittance.agree",
                "scenes.*.value", "passivity.*.energy.*", "passivity.none.gain", "spare.energy.max",
                "spare.none.energy.max", "spare.firm.energy", "spare.session.energy.max", "spare.ball.*",
                "work_precision.error.max"}}}};

}  // namespace
}  // namespace enc::bench::stability
