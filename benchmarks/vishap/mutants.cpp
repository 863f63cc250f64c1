// Changes that turn the bounds of this benchmark red (bench --mutate).
#include "benchmarks/kit/mutants.h"

namespace enc::bench::vishap {
namespace {

const Mutants kMutants{
    "vishap",
    {{.what = "camera believed 9 mm beside its place",
      .set = {"rig.frames.W_C.position_mm=[236,-417,457]"},
      .kills = {"wall.miss_mm.*.max", "removal.device_percent.mean", "removal.device_percent.worst",
                "overlay.error_px.shipped"}},
     {.what = "the law of the wall half as stiff again, of the button four times softer; a finger without "
              "radius; another seed; a margin of 12 px around the arm; the camera's picture for the one "
              "without the device",
      .changes = {"other_law", "forgets_radius", "other_seed", "wide_margin", "device_stays"},
      .kills = {"fig5.*.*", "wall.same_hash.count", "removal.background_percent.mean",
                "removal.residual.mean"}},
     {.what = "a stiffness that ends with its contact, which any picture may end; no compensation of weight; "
              "a camera of 15 Hz",
      .set = {"rig.arm.passivity=\"controlled\"", "rig.contact.leave_gap_mm=0.001",
              "rig.arm.gravity=\"none\"", "rig.camera.rate_hz=15", "truth.camera.rate_hz=15"},
      .kills = {"wall.force_step.max", "button.waits_mm.max", "wall.frames.rate"}},
     {.what = "a hue of skin that the arm has",
      .set = {"rig.vision.skin_hue_deg=215", "rig.vision.skin_spread_deg=20"},
      .kills = {"removal.hand_kept_percent.mean", "arm_in_view.with.open.found_percent",
                "arm_in_view.mistaken.count"}}}};

}  // namespace
}  // namespace enc::bench::vishap
