// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::tracking {
namespace {

const Mutants kMutants{
    "tracking",
    {{.what = "machine 1.5 mm lower than believed; bias turned and 1.3 times as large; noise smoothed; "
              "prediction of the wrong side; half the later latency; theory without a wait; 1 ms left in; "
              "logs 2 ms late and "
              "20 um aside; holding for constant velocity",
      .set = {"truth.hexapod.misplaced_mm=[0,0,-1.5]", "truth.tracker.bias_mm=[-0.1013,-0.0857,-0.155]"},
      .changes = {"smoothed_noise", "bias_adds", "half_as_late", "theory_without_wait", "late_by_1ms",
                  "late_logs", "hold_for_velocity", "no_shake"},
      .kills = {"rmse.*.*", "mae.*.*", "rmse_over_static.*.*", "from_20.*.*.*", "latency_gain.*.*",
                "theory.max", "exact.max", "noise.*", "forensics.latency.percent", "forensics.bias.percent",
                "predicted.*.contact_ms.*", "predicted.hold.polled.rmse.norm.*",
                "predicted.cv.event.rmse.norm.40", "predicted.cv.event.rmse.norm.there_and_back.40",
                "predicted.cv.event.rmse.norm.*.there_and_back.40", "predicted.cv.polled.peak.drop_out.*",
                "predicted.cv.polled.rmse.norm.loss"}}}};

}  // namespace
}  // namespace enc::bench::tracking
