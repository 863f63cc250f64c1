// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::registration {
namespace {

const Mutants kMutants{"registration",
                       {{.what = "standing error of the stereo matching 1 px; points 10 nm off",
                         .set = {"truth.camera.standing_px=1"},
                         .changes = {"points_off"},
                         .kills = {"x_mm", "y_mm", "z_mm", "held_out.*", "twin.*", "single.*", "fewest.*",
                                   "frames.*.below.percent", "frames.enough.count", "exact.max_m"}}}};

}  // namespace
}  // namespace enc::bench::registration
