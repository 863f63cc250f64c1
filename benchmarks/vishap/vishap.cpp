#include "benchmarks/vishap/vishap.h"

#include "benchmarks/kit/force_precision.h"

namespace enc::bench::vishap {
namespace {

void run(Bench& bench) {
  add_whole_stack(bench);
  add_device_removal(bench);
  // A stroke, as the camera sees it.
  add_force_precision(bench, {"user.approach_mm_s=[100]", "user.approach_from_mm=40", "user.press_s=0.6",
                              "user.hold_s=0.3", "user.release_s=0.4", "user.rest_s=0.3"});
}

const Entry kEntry{"vishap", "camera/wall", "the whole stack of VisHap: a finger that is seen meets the prop",
                   run};

}  // namespace
}  // namespace enc::bench::vishap
