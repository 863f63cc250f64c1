// The shape of an arm against its kinematics: it ends where the tip is, and its links join.
#include "core/machine/arm_shape.h"

#include <cmath>

#include <gtest/gtest.h>

namespace enc {
namespace {

const Pose<'W', 'R'> kBase(Quat(Eigen::AngleAxisd(0.4, Vec3(0.2, -0.5, 1.0).normalized())),
                           Vec3(0.1, -0.2, 0.3));
const std::array<PerJoint, 3> kPoses{{{0, 0, 0}, {0.5, 0.3, 0.2}, {-0.7, -0.4, 0.6}}};

Vec3 end_of(const ArmPart& part, double end) {
  return part.middle.e() + end * part.half.z() * part.axes.col(2);
}

// Whether a rod of that radius has an end there.
bool ends_at(const std::vector<ArmPart>& parts, const Point<'W'>& at, double radius) {
  for (const ArmPart& part : parts)
    for (const double end : {-1.0, 1.0})
      if (std::abs(part.half.x() - radius) < 1e-9 && (end_of(part, end) - at.e()).norm() < 1e-12) return true;
  return false;
}

TEST(ArmShape, APhantomsForearmEndsAtTheTipAndBeginsAtTheElbow) {
  const Arm arm{ArmMachine{}};
  const PhantomGeometry& g = arm.machine().phantom;
  for (const PerJoint& q : kPoses) {
    const auto parts = arm_shape(arm.machine(), q, kBase);
    const Vec3 ahead(std::cos(q[0]), std::sin(q[0]), 0.0);
    const Vec3 elbow = g.l1 * (std::cos(q[1]) * ahead + std::sin(q[1]) * Vec3::UnitZ());
    const Vec3 fore = std::sin(q[2]) * ahead - std::cos(q[2]) * Vec3::UnitZ();
    EXPECT_TRUE(ends_at(parts, kBase * arm.tip(q), 0.0045));                    // forearm
    EXPECT_TRUE(ends_at(parts, kBase * Point<'R'>(elbow), 0.0045));             // likewise
    EXPECT_TRUE(ends_at(parts, kBase * Point<'R'>(elbow), 0.0055));             // upper arm
    EXPECT_TRUE(ends_at(parts, kBase * Point<'R'>(Vec3(g.l3 * fore)), 0.005));  // crank
    EXPECT_TRUE(ends_at(parts, kBase * Point<'R'>(Vec3(g.l3 * fore)), 0.003));  // link of the parallelogram,
    EXPECT_TRUE(ends_at(parts, kBase * Point<'R'>(Vec3(elbow + g.l3 * fore)), 0.003));  // to the forearm
  }
}

TEST(ArmShape, OfAPhantomTheBaseAloneStandsStill) {
  const ArmMachine machine;
  const auto one = arm_shape(machine, kPoses[0], kBase), other = arm_shape(machine, kPoses[1], kBase);
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i)
    EXPECT_EQ((one[i].middle - other[i].middle).norm() < 1e-12, i < 3) << i;  // disc, column, turret
}

// A slide along x, then a hinge about y: the tip hangs 0.1 m below it.
TEST(ArmShape, AChainEndsAtItsTip) {
  ArmMachine machine;
  machine.kind = ArmKind::chain;
  machine.links = {
      {"x", JointKind::slide, {1, 0, 0}, {0, 0, 0.2}, 0.1, {0, 0, 0}, {1e-5, 1e-5, 1e-5}},
      {"swing", JointKind::hinge, {0, 2, 0}, {0.03, 0, 0}, 0.1, {0, 0, -0.05}, {1e-5, 1e-5, 1e-5}}};
  machine.tip = {0, 0, -0.1};
  machine.drives[0].low = -0.1;
  machine.drives[0].high = 0.15;
  const Arm arm(machine);
  for (const PerJoint& q : {PerJoint{0, 0, 0}, PerJoint{0.07, 0.5, 0}}) {
    const auto parts = arm_shape(machine, q, kBase);
    EXPECT_TRUE(ends_at(parts, kBase * arm.tip(q), 0.006));
    EXPECT_TRUE(ends_at(parts, kBase * Point<'R'>(-0.1, 0, 0.2), 0.004));  // the rail does not move
    EXPECT_TRUE(ends_at(parts, kBase * Point<'R'>(0.15, 0, 0.2), 0.004));
  }
}

TEST(ArmShape, APropsFrontIsAtTheTipAndFacesAlongTheNormal) {
  const Quat q_WN(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitY()));  // its normal is along x of W
  const ArmPart prop = prop_shape({0.03, 0.05, 0.002}, Point<'W'>(0.1, 0.2, 0.3), q_WN);
  EXPECT_EQ(prop.form, PartForm::box);
  EXPECT_LT((end_of(prop, 1.0) - Vec3(0.1, 0.2, 0.3)).norm(), 1e-12);
  EXPECT_LT((end_of(prop, -1.0) - Vec3(0.098, 0.2, 0.3)).norm(), 1e-12);
  EXPECT_LT((prop.axes.col(1) - Vec3::UnitY()).norm(), 1e-12);
  EXPECT_DOUBLE_EQ(prop.half.y(), 0.025);
}

}  // namespace
}  // namespace enc
