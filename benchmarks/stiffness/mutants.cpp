// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::stiffness {
namespace {

const Mutants kMutants{
    "stiffness",
    {{.what = "threshold of the force x 2",
      .set = {"rig.force.threshold_N=0.1"},
      .kills = {"error_percent.0.3.mean", "error_percent.0.5.mean", "error_percent.1.mean",
                "error_percent.2.mean", "error_percent.5.mean", "error_percent.10.mean",
                "error_percent.20.mean"}},
     {.what = "machine's step x 4",
      .set = {"truth.hexapod.step_um=12"},
      .kills = {"error_percent.10.mean", "error_percent.50.mean", "error_percent.100.mean",
                "error_percent.200.mean"}},
     {.what = "threshold x 15, step x 10",
      .set = {"rig.force.threshold_N=0.75", "truth.hexapod.step_um=30"},
      .kills = {"error_percent.*.worst", "error_percent.*.*.worst", "beyond.*.error_percent.*.worst",
                "beyond.*.error_percent.*.*.worst"}},
     {.what = "pusher half as stiff, no threshold, no damper; theory without dead time; a quarter softer "
              "than said",
      .set = {"truth.pusher.stiffness_N_per_mm=0.02", "rig.force.threshold_N=0",
              "rig.admittance.damping=none"},
      .changes = {"no_dead_time", "softer"},
      .kills = {"unstable.0.02.percent", "lowest_stable_N_per_mm", "error.slope",
                "firm.boundary_over_linear.ratio", "softest.moving", "beyond.*.boundary_N_per_mm"}},
     {.what = "pusher twice as stiff; the threshold stays",
      .set = {"truth.pusher.stiffness_N_per_mm=0.08"},
      .changes = {"keep_threshold"},
      .kills = {"unstable.0.035.percent", "no_threshold_no_drift.error_percent.max",
                "no_threshold_no_drift.load_error_percent.max"}}}};

}  // namespace
}  // namespace enc::bench::stiffness
