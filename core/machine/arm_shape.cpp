#include "core/machine/arm_shape.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/rotation.h"

namespace enc {
namespace {

// Assembles solids that are given in the frame of a link, or of the base.
class Shape {
 public:
  explicit Shape(const Pose<'W', 'R'>& X_WR) : X_WR_(X_WR) {}

  // Sets the link whose frame has its origin at `at` in R and these axes in R.
  void in(const Vec3& at, const Mat3& axes) {
    at_ = at;
    axes_ = axes;
  }
  void rod(PartForm form, const Vec3& from, const Vec3& to, double radius, Material material) {
    const Vec3 a = at_ + axes_ * from, along = axes_ * (to - from);
    const double length = along.norm();
    const Quat z_to_it = length > 0.0 ? rotation_z_to(along / length) : Quat::Identity();
    parts_.push_back({form, material, X_WR_ * Point<'R'>(Vec3(a + 0.5 * along)),
                      (X_WR_.q() * z_to_it).toRotationMatrix(), Vec3(radius, radius, 0.5 * length)});
  }
  [[nodiscard]] std::vector<ArmPart> take() { return std::move(parts_); }

 private:
  Pose<'W', 'R'> X_WR_;
  Vec3 at_ = Vec3::Zero();
  Mat3 axes_ = Mat3::Identity();
  std::vector<ArmPart> parts_;
};

constexpr auto kCapsule = PartForm::capsule, kCylinder = PartForm::cylinder;

// The frames of upper arm and forearm have x along the arm as it lies at q = 0, ahead, and z upwards.
void add_phantom(const PhantomGeometry& g, const PerJoint& q, Shape& shape) {
  const Mat3 turret = Eigen::AngleAxisd(q[0], Vec3::UnitZ()).toRotationMatrix();
  const auto lifted = [&](double angle) {
    return Mat3(turret * Eigen::AngleAxisd(-angle, Vec3::UnitY()).toRotationMatrix());
  };
  const Mat3 upper = lifted(q[1]), fore = lifted(q[2]);
  const Vec3 o = Vec3::Zero(), down = -Vec3::UnitZ();
  shape.rod(kCylinder, {0, 0, -g.l2 - 0.02}, {0, 0, -g.l2 - 0.05}, 0.06, Material::dark);
  shape.rod(kCylinder, {0, 0, -g.l2 - 0.03}, {0, 0, -0.055}, 0.012, Material::metal);
  shape.in(o, turret);
  shape.rod(kCylinder, {0, 0, -0.055}, {0, 0, -0.035}, 0.040, Material::painted);
  for (const double side : {-0.022, 0.022})
    shape.rod(kCapsule, {0, side, -0.035}, {0, side, 0}, 0.006, Material::metal);
  shape.in(o, upper);
  shape.rod(kCylinder, {g.l5, 0, 0}, {2.4 * g.l5, 0, 0}, 0.0125,
            Material::dark);  // its motor, a counterweight
  shape.rod(kCapsule, {g.l5, 0, 0}, {g.l1, 0, 0}, 0.0055, Material::metal);
  shape.in(upper * Vec3(g.l1, 0, 0), fore);
  shape.rod(kCapsule, o, g.l2 * down, 0.0045, Material::metal);
  shape.in(o, fore);  // the crank, parallel to the forearm, with the other motor
  const Vec3 end = g.l3 * down;
  shape.rod(kCapsule, -1.2 * g.l6 * down, -1.8 * g.l6 * down, 0.0125, Material::dark);
  shape.rod(kCapsule, -g.l6 * down, end, 0.005, Material::metal);
  shape.in(fore * end, upper);  // the link, parallel to the upper arm
  shape.rod(kCapsule, o, {g.l1, 0, 0}, 0.003, Material::metal);
}

void add_chain(const ArmMachine& machine, const PerJoint& q, Shape& shape) {
  constexpr double kShort = 1e-3;  // m: no rod joins parts that are closer
  const Vec3 o = Vec3::Zero();
  Vec3 at = o;
  Mat3 axes = Mat3::Identity();
  for (std::size_t i = 0; i < std::min(machine.links.size(), kMostJoints); ++i) {
    const ChainLink& link = machine.links[i];
    const Vec3 axis = link.axis.normalized();
    shape.in(at, axes);
    if (link.kind == JointKind::slide)  // its rail
      shape.rod(kCapsule, link.origin + machine.drives[i].low * axis,
                link.origin + machine.drives[i].high * axis, 0.004, Material::painted);
    if (link.origin.norm() > kShort) shape.rod(kCapsule, o, link.origin, 0.006, Material::painted);
    at += axes * link.origin;
    if (link.kind == JointKind::slide)
      at += q[i] * (axes * axis);
    else
      axes *= Eigen::AngleAxisd(q[i], axis).toRotationMatrix();
    shape.in(at, axes);
    shape.rod(kCapsule, o, link.centre, 0.008, Material::metal);
  }
  if (machine.tip.norm() > kShort) shape.rod(kCapsule, o, machine.tip, 0.006, Material::metal);
}

}  // namespace

std::vector<ArmPart> arm_shape(const ArmMachine& machine, const PerJoint& q, const Pose<'W', 'R'>& X_WR) {
  Shape shape(X_WR);
  if (machine.kind == ArmKind::phantom)
    add_phantom(machine.phantom, q, shape);
  else
    add_chain(machine, q, shape);
  return shape.take();
}

ArmPart prop_shape(const Vec3& size, const Point<'W'>& tip, const Quat& q_WN) {
  const Vec3 half = 0.5 * size;
  return {PartForm::box, Material::plate, tip - Vec<'W'>(Vec3(q_WN * Vec3(0, 0, half.z()))),
          q_WN.toRotationMatrix(), half};
}

}  // namespace enc
