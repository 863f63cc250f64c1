// What an arm and its prop look like: a few convex solids in W, for whoever draws the arm or takes it out of
// a picture. The twin asks with what is true, the core with what is measured and believed.
#pragma once

#include <cstdint>
#include <vector>

#include "core/machine/arm.h"

namespace enc {

enum class PartForm : std::uint8_t { capsule, cylinder, box };
enum class Material : std::uint8_t { metal, dark, painted, plate };  // plate: of the prop

struct ArmPart {
  PartForm form = PartForm::capsule;
  Material material = Material::metal;
  Point<'W'> middle;
  Mat3 axes = Mat3::Identity();  // its x, y and z as columns, in W
  // m. Box: half its sides. Capsule and cylinder: x and y are the radius, z half the length along z, of a
  // capsule without its caps.
  Vec3 half{0, 0, 0};
};

// Links and base. A PHANToM as its data sheet pictures it, with the lengths of the machine; of another chain
// what is known: its joints, rails and centres of mass.
[[nodiscard]] std::vector<ArmPart> arm_shape(const ArmMachine& machine, const PerJoint& q,
                                             const Pose<'W', 'R'>& X_WR);
// A prop of that size (PropSpec::size) at the arm's tip, whose front faces along z of N.
[[nodiscard]] ArmPart prop_shape(const Vec3& size, const Point<'W'>& tip, const Quat& q_WN);

}  // namespace enc
