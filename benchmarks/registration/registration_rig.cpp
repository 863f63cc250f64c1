#include <cmath>

#include <fmt/format.h>

#include "benchmarks/registration/registration.h"
#include "core/error.h"
#include "core/rotation.h"

namespace enc::bench {
namespace {

// A set-up whose rig and truth describe an arm.
template <class Setup>
concept WithArm = requires(const Setup& setup) {
  setup.rig.arm.machine;
  setup.twin.arm.machine;
};

template <class Setup>
RegistrationRig rig_of(const Setup& setup) {
  RegistrationRig rig;
  rig.camera = setup.twin.camera;
  if constexpr (WithArm<Setup>) {
    if (setup.rig.arm.driver == "none")
      throw Error(fmt::format(
          "{}:1:1: this rig has no arm; expected [arm] with a driver, because the arm carries the "
          "tip through the camera's view; name another rig, such as vishap",
          setup.rig_path));
    rig.believed = setup.rig.arm.machine;
    rig.arm = setup.twin.arm;
    rig.least_dexterity = setup.rig.arm.least_dexterity;
    rig.X_WC = {rotation_xyz(setup.twin.frames.W_C.rotation), setup.twin.frames.W_C.position};
  } else {
    // 0.6 m from the middle of the arm's volume, before it to its right and above, looking at it.
    rig.X_WC = {rotation_xyz(Vec3(-125.0, 0.0, 30.0) * M_PI / 180.0), Vec3(0.236, -0.426, 0.457)};
  }
  return rig;
}

}  // namespace

RegistrationRig registration_rig(const models::Setup& setup) { return rig_of(setup); }

}  // namespace enc::bench
