// The PHANToM Premium in closed form: kinematics, statics [VisHap eq. 5] and mass matrix, after Cavusoglu,
// Feygin and Tendick (2002). Angles, lengths and bodies are those of PhantomGeometry.
#pragma once

#include "core/machine/arm.h"

namespace enc::phantom {

[[nodiscard]] Vec3 tip(const PhantomGeometry& geometry, const PerJoint& q) noexcept;       // in R, m
[[nodiscard]] Mat3 jacobian(const PhantomGeometry& geometry, const PerJoint& q) noexcept;  // d tip / d q

// Joints that place the tip at p. Upper arm and forearm fold only one way, q2 - q3 in [-90, 90] deg. `ahead`
// selects one of the two remaining turret angles: the one that faces p, or the one that leans over backwards
// to it. Returns false if p is out of reach.
[[nodiscard]] bool inverse(const PhantomGeometry& geometry, const Vec3& p, bool ahead, PerJoint& q) noexcept;

[[nodiscard]] PerJoint gravity(const PhantomGeometry& geometry, const PerJoint& q, double payload,
                               Payload form) noexcept;
// Excludes the rotors; the payload acts at the tip.
[[nodiscard]] Mat3 mass(const PhantomGeometry& geometry, const PerJoint& q, double payload) noexcept;

}  // namespace enc::phantom
