// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::reaching {
namespace {

const Mutants kMutants{
    "reaching",
    {{.what = "prop four times as hard; joints without friction",
      .set = {"truth.arm.contact_time_ms=1", "truth.arm.friction_Nm=[0,0,0]"},
      .kills = {"far_speed_mm_s", "rest.far_speed_mm_s"}},
     {.what = "finger seen 25 mm aside with 3 mm noise by a camera of 59 ms; contact left at "
              "0.01 mm",
      .set = {"truth.tracker.bias_mm=[25,0,0]", "truth.tracker.noise_mm=[3,3,3]",
              "truth.tracker.latency_ms=59", "rig.contact.leave_gap_mm=0.01"},
      .kills = {"*.lead_percent.*", "*.felt_percent", "near_percent.*.steady", "miss_mm.*.*.*",
                "*.force_step_N.*", "*.contacts_per_reach"},
      .form = Form::usual}}};

}  // namespace
}  // namespace enc::bench::reaching
