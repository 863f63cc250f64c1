// A serial chain of hinges and slides (ChainLink): kinematics, statics and mass matrix of an arm that is not
// a PHANToM. It reads ArmMachine::links; Arm ensures 1 to kMostJoints links with unit axes.
#pragma once

#include "core/machine/arm.h"

namespace enc::chain {

[[nodiscard]] Vec3 tip(const ArmMachine& machine, const PerJoint& q) noexcept;       // in R, m
[[nodiscard]] Mat3 jacobian(const ArmMachine& machine, const PerJoint& q) noexcept;  // d tip / d q

// Joints within the drives' limits that place the tip within 1e-9 m of p. With fewer joints than directions,
// they place the tip nearest to p, as far as the search finds it. The search starts from `q` and from
// positions spread over the limits. Returns false and keeps q if no search ends within the limits. Takes at
// most about 0.2 ms.
[[nodiscard]] bool inverse(const ArmMachine& machine, const Vec3& p, PerJoint& q) noexcept;

// The payload acts at the tip.
[[nodiscard]] PerJoint gravity(const ArmMachine& machine, const PerJoint& q, double payload) noexcept;
// Excludes the rotors.
[[nodiscard]] Mat3 mass(const ArmMachine& machine, const PerJoint& q, double payload) noexcept;

}  // namespace enc::chain
