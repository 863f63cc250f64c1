// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::extremes {
namespace {

const Mutants kMutants{
    "extremes",
    {{.what =
          "one infinite tick in each run; tools, steps, places and points exchanged; what is seen judged a "
          "tick late or too early; longer out of sight; a storm that goes on; memory kept",
      .changes = {"unsound_tick", "quiet", "front_20mm_higher", "half_speed", "two_contacts",
                  "limit_1mm_less", "too_early", "no_hysteresis", "a_tick_late", "any_change", "other_seed",
                  "exchange_values", "unseen_for_longer", "storm_goes_on", "keeps_ticks", "late_work_doubled",
                  "fault_that_stays"},
      .kills = {"*.*.broken.value",
                "*.*.*.broken.value",
                "arm.wall.*.named.value",
                "*.impact.*.through.value",
                "*.impact.*.arrives.value",
                "hexapod.training.torn.value",
                "hexapod.training.deeper.max",
                "*.leaves.back.max",
                "hexapod.saturated.*.value",
                "hexapod.saturated.moved.max",
                "*.trembles.*.value",
                "*.coincident.*.value",
                "*.inputs.*.value",
                "*.dropout.*.late.value",

                "*.stall.*.late.value",
                "*.stall.*.held.percent",

                "hexapod.*.held.value",
                "hexapod.twice.other.value",
                "*.storm.belief.ratio",
                "*.storm.held_after.value",
                "*.hours.memory.max",
                "*.hours.work.ratio",
                "both.*.*.percent",
                "both.mesh.not_finite.value",

                "all.missed.value"}},
     {.what =
          "machine 2 mm higher than believed, its step 50 um; no prediction; twice the arm's force; softer "
          "stops; a machine that carries 98 N; a slow filter of the arm; a pusher that shakes and "
          "pushes twice as hard",
      .set = {"truth.hexapod.misplaced_mm=[0,0,2]", "truth.hexapod.step_um=50", "rig.tracker.prediction=hold",
              "rig.arm.peak_N=17", "truth.world.contact_time_ms=10", "truth.arm.contact_time_ms=10",
              "rig.manipulator.payload_N=98.1", "rig.arm.filter_hz=1", "truth.pusher.tremor_N=20",
              "pusher.force_max_N=60", "pusher.depth_mm=20", "object.ball.position_mm=[0,0,-14]"},
      .kills = {"arm.wall.*.swing.max", "hexapod.wall.*.touch.max", "hexapod.wall.*.swing.max",
                "hexapod.deep.start.value", "hexapod.deep.back.max", "hexapod.deep.outside.max",
                "hexapod.training.outside.max", "*.impact.*.into.max", "*.dropout.*.error.max",
                "hexapod.overloaded.said.value", "hexapod.*.rms.value", "hexapod.overloaded.given.max"}},
     {.what = "a wall twice as stiff",
      .set = {"behaviour.phantom_wall.stiffness_N_per_mm=1.2"},
      .kills = {"arm.deep.exit_speed.max"}}}};

}  // namespace
}  // namespace enc::bench::extremes
