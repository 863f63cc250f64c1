// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::synchrony {
namespace {

const Mutants kMutants{
    "synchrony",
    {{.what = "the paper's MAE and RMSE 14 % smaller",
      .changes = {"smaller_reference"},
      .kills = {"mae_mm", "rmse_mm"}},
     {.what = "tracker's bias turned; signals of the lag exchanged; machine 0.1 mm lower",
      .set = {"truth.hexapod.misplaced_mm=[0,0,-0.1]"},
      .changes = {"turned_bias", "exchanged_signals"},
      .kills = {"bias_mm", "lag_ms", "fused.lag_ms", "latency_gain.lag_ms", "limit.*.over_mm"}},
     {.what = "machine's step 50 um; contact left at 0.01 mm; the fused tip without lead",
      .set = {"truth.hexapod.step_um=50", "rig.contact.leave_time_ms=1", "rig.contact.leave_gap_mm=0.01",
              "rig.display.lead_ms=0"},
      .kills = {"contacts", "fused.mae_mm"}}}};

}  // namespace
}  // namespace enc::bench::synchrony
