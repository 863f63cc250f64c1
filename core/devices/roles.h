// The one table of roles: the names of each, and its place in scene, rig file, driver, rig and inputs.
#pragma once

#include <optional>

#include "core/devices/driver.h"
#include "core/devices/rig.h"
#include "core/spec/scene_spec.h"

namespace enc {

enum class RoleId : std::uint8_t { manipulator, arm, force, tracker, display, gripper, hand_tracker };
inline constexpr std::size_t kRoles = 6;    // of the loop
inline constexpr std::size_t kDevices = 7;  // of a rig

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

// A device of the rig that is not of the loop: the core neither sees it nor holds because of it.
template <class Device, class SceneTable, class RigTable>
struct SideRole {
  RoleId id;
  const char *table, *name;
  std::optional<SceneTable> SceneSpec::*scene;
  RigTable RigSpec::*rig;
  Maker<Device> DriverModule::*make;
  std::unique_ptr<Device> Rig::*slot;
};
template <class Device, class SceneTable, class RigTable>
SideRole(RoleId, const char*, const char*, std::optional<SceneTable> SceneSpec::*, RigTable RigSpec::*,
         Maker<Device> DriverModule::*, std::unique_ptr<Device> Rig::*)
    -> SideRole<Device, SceneTable, RigTable>;

// The roles of the loop, then the others.
template <class F>
void each_device(F f) {
  each_role([&f](const auto& role) { f(role); });
  f(SideRole{RoleId::hand_tracker, "hand_tracker", "hand tracker", &SceneSpec::hand_tracker,
             &RigSpec::hand_tracker, &DriverModule::hand_tracker, &Rig::hand_tracker});
}

}  // namespace enc
