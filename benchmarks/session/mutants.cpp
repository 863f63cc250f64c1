// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::session {
namespace {

const Mutants kMutants{
    "session",
    {{.what =
          "contact force turned, tools exchanged under touch, one set-point in a hundred 1 mm off; contact "
          "of the training left at once",
      .changes = {"changed_truth", "left_at_once"},
      .kills = {"command.over", "tension_N", "mistaken_tool.count", "training.one_contact_percent"}},
     {.what =
          "contact left at once; machine 2 mm higher than believed, its step 50 um; tracker 100 ms late and "
          "6 mm too low",
      .set = {"rig.contact.leave_time_ms=1", "rig.contact.leave_gap_mm=0.01",
              "truth.hexapod.misplaced_mm=[0,0,2]", "truth.hexapod.step_um=50",
              "truth.tracker.latency_ms=100", "truth.tracker.bias_mm=[0,0,-6]"},
      .kills = {"presses.one_contact_percent", "aborted.contacts", "limit.over_mm", "tool_change.*.max"},
      .form = Form::usual}}};

}  // namespace
}  // namespace enc::bench::session
