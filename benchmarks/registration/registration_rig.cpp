#include <fmt/format.h>

#include "benchmarks/registration/registration.h"
#include "core/error.h"
#include "core/rotation.h"

namespace enc::bench {

RegistrationRig registration_rig(const models::Setup& setup) {
  if (setup.rig.arm.driver == "none")
    throw Error(
        fmt::format("{}:1:1: this rig has no arm; expected [arm] with a driver, because the arm carries the "
                    "tip through the camera's view; name another rig, such as vishap",
                    setup.rig_path));
  RegistrationRig rig;
  rig.camera = setup.twin.camera;
  rig.believed = setup.rig.arm.machine;
  rig.arm = setup.twin.arm;
  rig.least_dexterity = setup.rig.arm.least_dexterity;
  rig.X_WC = {rotation_xyz(setup.twin.frames.W_C.rotation), setup.twin.frames.W_C.position};
  return rig;
}

}  // namespace enc::bench
