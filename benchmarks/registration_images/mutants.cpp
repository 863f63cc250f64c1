// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::registration_images {
namespace {

const Mutants kMutants{
    "registration_images",
    {{.what = "lens that bends (k1 -0.2), noise 20 of 255; every place taken for the first",
      .set = {"truth.camera.distortion=[-0.2,0,0,0,0]", "truth.camera.noise_of_255=20"},
      .changes = {"first_place"},
      .kills = {"found.percent", "other.count", "frame.bias.*", "frame.scatter.*", "still.max"}},
     {.what = "right camera believed turned by 0.4 deg",
      .set = {"rig.camera.right.rotation_deg=[0,0.4,0]"},
      .kills = {"x_mm", "y_mm", "z_mm", "worst.*", "held_out.x_mm", "held_out.y_mm", "held_out.z_mm",
                "held_out.worst.*"}}}};

}  // namespace
}  // namespace enc::bench::registration_images
