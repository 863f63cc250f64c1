// The shape of an arm and its prop: a few convex solids in W, for code that draws the arm or removes it from
// a picture. The twin passes ground truth, the core passes measurements and rig data.
#pragma once

#include <cstdint>
#include <vector>

#include "core/machine/arm.h"

namespace enc {

enum class PartForm : std::uint8_t { capsule, cylinder, box };
enum class Material : std::uint8_t { metal, dark, painted, plate };  // plate: the prop's material

struct ArmPart {
  PartForm form = PartForm::capsule;
  Material material = Material::metal;
  Point<'W'> middle;
  Mat3 axes = Mat3::Identity();  // the solid's x, y and z as columns, in W
  // m. Box: half its sides. Capsule and cylinder: x and y are the radius, z is half the length along z,
  // without a capsule's caps.
  Vec3 half{0, 0, 0};
};

// Links and base. A PHANToM has the shape of its data sheet and the lengths of the machine; another chain
// shows its known parts: joints, rails and centres of mass.
[[nodiscard]] std::vector<ArmPart> arm_shape(const ArmMachine& machine, const PerJoint& q,
                                             const Pose<'W', 'R'>& X_WR);
// A prop of that size (PropSpec::size) at the arm's tip; its front faces along z of N.
[[nodiscard]] ArmPart prop_shape(const Vec3& size, const Point<'W'>& tip, const Quat& q_WN);

}  // namespace enc
