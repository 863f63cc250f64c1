// A serial chain of hinges and slides (ChainLink): kinematics, statics and mass matrix of an arm that is no
// PHANToM. Reads ArmMachine::links, of which there are 1 to kMostJoints with unit axes (Arm sees to it).
#pragma once

#include "core/machine/arm.h"

namespace enc::chain {

[[nodiscard]] Vec3 tip(const ArmMachine& machine, const PerJoint& q) noexcept;       // in R, m
[[nodiscard]] Mat3 jacobian(const ArmMachine& machine, const PerJoint& q) noexcept;  // d tip / d q

// The joints, within the drives' limits, that put the tip within 1e-9 m of p; with fewer joints than ways,
// where the tip is nearest to p as far as a search from `q` and from places spread over the limits finds.
// False, and q as it was, where none of them ends within the limits. At most about 0.2 ms.
[[nodiscard]] bool inverse(const ArmMachine& machine, const Vec3& p, PerJoint& q) noexcept;

// Payload at the tip.
[[nodiscard]] PerJoint gravity(const ArmMachine& machine, const PerJoint& q, double payload) noexcept;
// Without rotors.
[[nodiscard]] Mat3 mass(const ArmMachine& machine, const PerJoint& q, double payload) noexcept;

}  // namespace enc::chain
