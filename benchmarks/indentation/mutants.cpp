// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::indentation {
namespace {

const Mutants kMutants{
    "indentation",
    {{.what = "cells of Table 2 exchanged", .changes = {"exchange_cells"}, .kills = {"rmse.*.*", "bias.*.*"}},
     {.what = "curves of A, B and C exchanged; A alone elsewhere; the other law; lag without the delay",
      .changes = {"exchange_curves", "unmixed", "other_law", "no_delay"},
      .kills = {"mae.*.*", "apart.*.ratio", "accuracy.rmse.*.*", "directions.*.rmse", "minor.*.rmse",
                "lag.ratio"}},
     {.what = "noise of the force sensor x 4; machine 0.2 mm lower than believed",
      .set = {"truth.force.noise_N=0.05", "truth.hexapod.misplaced_mm=[0,0,-0.2]"},
      .kills = {"sensor.noise.rms", "peak_N", "overshoot_mm", "deadband.*.percent"}},
     {.what = "hand x 3: tremor, drift, spread of its times; a press of 4 s",
      .set = {"truth.hand.tremor_mm=0.18", "truth.hand.drift_mm=0.45", "user.press_s=4", "user.release_s=4"},
      .changes = {"restless_hand"},
      .kills = {"sensor.rmse.*.*", "truth.rmse.*.*", "truth.tremor.rms", "repeatability_N"}},
     {.what = "tracker's noise 1 mm, contact left at 0.01 mm",
      .set = {"truth.tracker.noise_mm=[1,1,1]", "rig.contact.leave_time_ms=1",
              "rig.contact.leave_gap_mm=0.01"},
      .kills = {"contacts_per_press.ratio"}}}};

}  // namespace
}  // namespace enc::bench::indentation
