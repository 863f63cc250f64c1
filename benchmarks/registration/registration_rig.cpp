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
  if (setup.rig.arm.driver != "sim")
    throw Error(
        fmt::format("{}: this rig's arm is driven by '{}', and the guided procedure moves a simulated one; "
                    "expected driver "
                    "\"sim\"; of a real arm record the places and give them as POINTS.csv",
                    models::place_of(setup, "rig.arm.driver"), setup.rig.arm.driver));
  if (!setup.twin.arm.there)
    throw Error(fmt::format(
        "{}: the rig's arm is simulated and nothing says what it is; expected [truth.arm]; add it",
        models::place_of(setup, "rig.arm")));
  RegistrationRig rig;
  rig.camera = setup.twin.camera;
  rig.believed = setup.rig.arm.machine;
  rig.arm = setup.twin.arm;
  rig.least_dexterity = setup.rig.arm.least_dexterity;
  rig.X_WC = {rotation_xyz(setup.twin.frames.W_C.rotation), setup.twin.frames.W_C.position};
  return rig;
}

}  // namespace enc::bench
