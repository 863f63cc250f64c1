// The one table of roles: the names of each, and its place in scene, rig file, driver, rig and inputs.
#pragma once

#include <optional>

#include "core/devices/driver.h"
#include "core/devices/rig.h"
#include "core/spec/scene_spec.h"

namespace enc {

enum class RoleId : std::uint8_t { manipulator, arm, force, tracker, display, gripper };
inline constexpr std::size_t kRoles = 6;

template <class Device, class SceneTable, class RigTable, class Reading>
struct Role {
  RoleId id;
  const char *table, *name;  // [force] of scene and rig file; "force sensor" in messages
  std::optional<SceneTable> SceneSpec::*scene;
  RigTable RigSpec::*rig;  // includes its `driver`
  Maker<Device> DriverModule::*make;
  std::unique_ptr<Device> Rig::*slot;
  Measurement<Reading> Inputs::*said;
};

// Clang before 17 cannot deduce these arguments by itself.
template <class Device, class SceneTable, class RigTable, class Reading>
Role(RoleId, const char*, const char*, std::optional<SceneTable> SceneSpec::*, RigTable RigSpec::*,
     Maker<Device> DriverModule::*, std::unique_ptr<Device> Rig::*, Measurement<Reading> Inputs::*)
    -> Role<Device, SceneTable, RigTable, Reading>;

template <class F>
void each_role(F f) {
  f(Role{RoleId::manipulator, "manipulator", "manipulator", &SceneSpec::manipulator, &RigSpec::manipulator,
         &DriverModule::manipulator, &Rig::manipulator, &Inputs::tip});
  f(Role{RoleId::arm, "arm", "arm", &SceneSpec::arm, &RigSpec::arm, &DriverModule::arm, &Rig::arm,
         &Inputs::arm});
  f(Role{RoleId::force, "force", "force sensor", &SceneSpec::force, &RigSpec::force, &DriverModule::force,
         &Rig::force, &Inputs::wrench});
  f(Role{RoleId::tracker, "tracker", "tracker", &SceneSpec::tracker, &RigSpec::tracker,
         &DriverModule::tracker, &Rig::tracker, &Inputs::tool});
  f(Role{RoleId::display, "display", "display", &SceneSpec::display, &RigSpec::display,
         &DriverModule::display, &Rig::display, &Inputs::dent});
  f(Role{RoleId::gripper, "gripper", "gripper", &SceneSpec::gripper, &RigSpec::gripper,
         &DriverModule::gripper, &Rig::gripper, &Inputs::grip});
}

}  // namespace enc
