// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::press {
namespace {

const Mutants kMutants{"press",
                       {{.what = "machine 2 mm higher than believed; its step 50 um",
                         .set = {"truth.hexapod.misplaced_mm=[0,0,2]", "truth.hexapod.step_um=50"},
                         .kills = {"restore.max", "outside.max", "over_limit.*.max"}},
                        {.what = "contact left at once, at 0.01 mm",
                         .set = {"rig.contact.leave_time_ms=1", "rig.contact.leave_gap_mm=0.01"},
                         .kills = {"one_contact.percent"}}}};

}  // namespace
}  // namespace enc::bench::press
