// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::session {
namespace {

const Mutants kMutants{
    "session",
    {{.what = "contact force turned, tools exchanged under touch, one set-point in a hundred 1 mm off, "
              "presses taken "
              "for reaches that turn back; machine 1 mm lower than believed",
      .set = {"truth.hexapod.misplaced_mm=[0,0,-1]"},
      .changes = {"changed_truth"},
      .kills = {"command.over", "tension_N", "mistaken_tool.count", "aborted.contacts", "limit.over_mm"}},
     {.what = "force sensor of the training with 2 N of noise",
      .changes = {"loud_sensor"},
      .kills = {"training.one_contact_percent"}},
     {.what =
          "contact left at once; machine 2 mm higher than believed, its step 50 um; tracker 6 mm too low; "
          "overlay that shows a tool once in 100 ms",
      .set = {"rig.contact.leave_time_ms=1", "rig.contact.leave_gap_mm=0.01",
              "truth.hexapod.misplaced_mm=[0,0,2]", "truth.hexapod.step_um=50",
              "truth.tracker.bias_mm=[0,0,-6]"},
      .changes = {"rare_overlay"},
      .kills = {"presses.one_contact_percent", "tool_change.*.max"},
      .form = Form::usual}}};

}  // namespace
}  // namespace enc::bench::session
