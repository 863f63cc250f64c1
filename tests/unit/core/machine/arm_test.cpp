// The arm against numbers worked by hand and those printed in sources/arm 4 and sources/arm 5.
#include "core/machine/arm.h"

#include <array>
#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/machine/arm_shape.h"
#include "core/machine/loop_model.h"

namespace enc {
namespace {

constexpr double kStall = 0.129, kContinuous = 0.0286;  // motor torque, N m (sources/arm 3)

// The model 1.5, whose numbers are published (sources/arm 2, sources/arm 3: Cavusoglu's set).
ArmMachine model_15() {
  ArmMachine m;
  m.phantom = {.l1 = 0.215,
               .l2 = 0.170,
               .l3 = 0.0325,
               .l5 = -0.0368,
               .l6 = 0.0527,
               .m_a = 0.0202,
               .m_c = 0.0249,
               .m_be = 0.2359,
               .m_df = 0.1906,
               .I_a = {0.4864e-4, 0.001843e-4, 0.4864e-4},
               .I_c = {0.959e-4, 0.959e-4, 0.0051e-4},
               .I_be = {11.09e-4, 10.06e-4, 0.591e-4},
               .I_df = {7.11e-4, 0.629e-4, 6.246e-4},
               .I_base = 11.87e-4};
  m.drives[0].ratio = 13.3;
  m.drives[1].ratio = m.drives[2].ratio = 11.2;
  return m;
}

// Tip force along x, y, z of R at q = 0, N: each joint moves the tip along one axis there.
Vec3 push(const Arm& arm, double motor_torque) {
  PerJoint torque;
  for (std::size_t i = 0; i < 3; ++i) torque[i] = motor_torque * arm.machine().drives[i].ratio;
  return arm.force(arm.jacobian({}), torque).e();
}

// Effective mass of the tip there, kg.
Vec3 tip_mass(const Arm& arm) {
  const Mat3 J = arm.jacobian({});
  return (J * arm.mass({}, 0.0).inverse() * J.transpose()).inverse().diagonal();
}

TEST(Phantom, AtZeroTheForearmHangsFromTheLevelUpperArm) {
  const Arm arm{ArmMachine{}};
  EXPECT_EQ(arm.joints(), 3U);
  const Vec3 home = arm.tip(arm.zero()).e();
  EXPECT_DOUBLE_EQ(home.x(), 0.1397);
  EXPECT_DOUBLE_EQ(home.y(), 0.0);
  EXPECT_DOUBLE_EQ(home.z(), -0.1130);
  // Turret a quarter to the left, upper arm straight up, forearm level: r = l2, z = l1.
  EXPECT_LT((arm.tip({M_PI / 2, M_PI / 2, M_PI / 2}).e() - Vec3(0, 0.1130, 0.1397)).norm(), 1e-15);
  // q1 moves the tip to the left at q = 0, q2 up, q3 forwards.
  const Mat3 J = arm.jacobian({});
  EXPECT_LT((J - (Mat3() << 0, 0, 0.1130, 0.1397, 0, 0, 0, 0.1397, 0).finished()).norm(), 1e-15);
}

TEST(Phantom, HasTheForcesOfItsMotors) {
  const Arm arm{ArmMachine{}};
  // x: 0.129 * 7.47 / 0.1130; y: 0.129 * 8.87 / 0.1397; z: 0.129 * 7.47 / 0.1397; sources/arm 5.
  EXPECT_LT((push(arm, kStall) - Vec3(8.528, 8.191, 6.898)).cwiseAbs().maxCoeff(), 0.001);
  EXPECT_LT((push(arm, kStall) - Vec3(8.52, 8.19, 6.89)).cwiseAbs().maxCoeff(), 0.01);
  EXPECT_LT((push(arm, kContinuous) - Vec3(1.89, 1.82, 1.53)).cwiseAbs().maxCoeff(), 0.005);
  EXPECT_LT((push(Arm{model_15()}, kStall) - Vec3(8.50, 7.98, 6.72)).cwiseAbs().maxCoeff(), 0.005);
}

TEST(Phantom, WeighsAtItsTipWhatIsPrinted) {
  EXPECT_LT((tip_mass(Arm{ArmMachine{}}) - Vec3(0.034, 0.075, 0.047)).cwiseAbs().maxCoeff(), 0.0005);
  const Arm published{model_15()};
  const Vec3 printed(3.76e-3, 2.56e-3, 1.06e-3);  // kg m^2, with rotors
  EXPECT_LT((published.mass({}, 0.0).diagonal() - printed).cwiseAbs().maxCoeff(), 0.005e-3);
  // y is 3.76e-3, rounded, over l1^2 there.
  EXPECT_LT((tip_mass(published) - Vec3(0.0367, 0.0813, 0.0553)).cwiseAbs().maxCoeff(), 0.0001);
  // A prop at the tip adds exactly its own mass there.
  const Mat3 J = published.jacobian({});
  const Vec3 laden = (J * published.mass({}, 0.020).inverse() * J.transpose()).inverse().diagonal();
  EXPECT_LT((laden - tip_mass(published) - Vec3::Constant(0.020)).norm(), 1e-12);
}

TEST(Phantom, GravityIsEquation5) {
  const Arm arm{ArmMachine{}};
  for (const double q2 : {-1.0, 0.0, 0.7}) {
    const PerJoint torque = arm.gravity({0.3, q2, 0.9}, 0.0, Payload::exact);
    EXPECT_DOUBLE_EQ(torque[0], 0.0);
    EXPECT_NEAR(torque[1], -26e-3 * std::cos(q2), 0.5e-3);
    EXPECT_NEAR(torque[2], -53e-3 * std::sin(0.9), 0.5e-3);
  }
  const PerJoint published = Arm{model_15()}.gravity({0, 0, M_PI / 2}, 0.0, Payload::exact);
  const double theirs = 9.81 / kStandardGravity;  // g of that page
  EXPECT_NEAR(theirs * published[1], -16.3e-3, 0.05e-3);
  EXPECT_NEAR(theirs * published[2], -73.8e-3, 0.05e-3);
}

TEST(Phantom, ThePublishedPayloadGivesJoint3HalfOfIt) {
  const Arm arm{ArmMachine{}};
  const PerJoint q{0.2, 0.4, 0.8};
  const PerJoint bare = arm.gravity(q, 0.0, Payload::published);
  const PerJoint published = arm.gravity(q, 0.020, Payload::published);
  const PerJoint exact = arm.gravity(q, 0.020, Payload::exact);
  const double weight = 0.020 * kStandardGravity;
  EXPECT_NEAR(exact[1] - bare[1], weight * 0.1397 * std::cos(0.4), 1e-15);
  EXPECT_NEAR(exact[2] - bare[2], weight * 0.1130 * std::sin(0.8), 1e-15);
  EXPECT_NEAR(published[1], exact[1], 1e-15);
  EXPECT_NEAR(published[2] - bare[2], 0.5 * (exact[2] - bare[2]), 1e-15);
}

TEST(Phantom, Equation4ThereAndBack) {
  const Arm arm{ArmMachine{}};
  const Mat3 J = arm.jacobian({0.3, 0.5, 0.2});
  const Vec<'R'> force(1.0, -2.0, 3.0);
  EXPECT_LT((arm.force(J, arm.torque(J, force)) - force).norm(), 1e-12);
}

TEST(Phantom, IsNeverNaNAtASingularPose) {
  const Arm arm{ArmMachine{}};
  const double on_axis = std::asin(-0.1397 * std::cos(0.8) / 0.1130);  // l1 c2 + l2 s3 = 0: above the turret
  const std::array<PerJoint, 4> singular{
      {{0, M_PI / 2, 0}, {0, 0, -M_PI / 2}, {0.4, 0.8, on_axis}, {0, 1.2, 1.2 - M_PI / 2}}};
  for (const PerJoint& q : singular) {
    const Mat3 J = arm.jacobian(q);
    EXPECT_LT(arm.dexterity(J), 1e-7) << q[1] << ' ' << q[2];
    const Vec<'R'> force = arm.force(J, {0.1, 0.1, 0.1});
    ASSERT_TRUE(force.finite());
    // Bounded by |tau| / (2 lambda), lambda = 0.05 of the Jacobian's size, which is l2 at least.
    EXPECT_LT(force.norm(), 0.1 * std::sqrt(3.0) / (2.0 * 0.05 * 0.1130)) << q[1] << ' ' << q[2];
  }
  EXPECT_DOUBLE_EQ(arm.force(Mat3::Zero(), {1, 1, 1}).norm(), 0.0);
  // Least over largest singular value: l2 over l1 at zero.
  EXPECT_NEAR(arm.dexterity(arm.jacobian({})), 0.1130 / 0.1397, 1e-12);
}

TEST(Phantom, KeepsItsLimits) {
  const Arm arm{ArmMachine{}};
  EXPECT_TRUE(arm.within_limits({}));
  EXPECT_TRUE(arm.within_limits({89 * kDegree, 0, 0}));
  EXPECT_FALSE(arm.within_limits({91 * kDegree, 0, 0}));
  EXPECT_FALSE(arm.within_limits({0, 120 * kDegree, 100 * kDegree}));
  EXPECT_FALSE(arm.within_limits({0, 0, -30 * kDegree}));
  EXPECT_TRUE(arm.within_limits({0, 60 * kDegree, 0}));
  EXPECT_FALSE(arm.within_limits({0, 66 * kDegree, 0}));  // q2 - q3 <= 65 deg
  EXPECT_TRUE(arm.within_limits({0, 0, 54 * kDegree}));
  EXPECT_FALSE(arm.within_limits({0, 0, 56 * kDegree}));  // q3 - q2 <= 55 deg
  EXPECT_FALSE(arm.within_limits({0, kUnset, 0}));
}

TEST(Phantom, RefusesWhatItCannotReach) {
  const Arm arm{ArmMachine{}};
  PerJoint q{7, 8, 9};
  for (const Point<'R'>& p : {Point<'R'>(0.3, 0, 0), Point<'R'>(0, 0, 0), Point<'R'>(0.01, 0, 0.01),
                              Point<'R'>(-0.1397, 0, -0.1130), Point<'R'>()}) {
    EXPECT_FALSE(arm.inverse(p, q));
    EXPECT_EQ(q, (PerJoint{7, 8, 9}));
  }
  ASSERT_TRUE(arm.inverse(arm.tip({}), q));
  for (const double joint : q) EXPECT_NEAR(joint, 0.0, 1e-14);
}

// A column along z with a stage along x on it, as in a two-axis machine.
ArmMachine stage() {
  ArmMachine m;
  m.kind = ArmKind::chain;
  m.links = {{"column", JointKind::slide, {0, 0, 2}, {0.1, 0, 0.2}, 0.5, {0, 0, 0}, {1e-4, 1e-4, 1e-4}},
             {"slide", JointKind::slide, {1, 0, 0}, {0, 0.05, 0}, 0.2, {0, 0, 0}, {1e-4, 1e-4, 1e-4}}};
  m.tip = {0.03, 0, 0};
  m.drives = {{{-0.05, 0.05, 100.0, 1e-6}, {-0.1, 0.1, 200.0, 1e-6}, {}}};
  return m;
}

TEST(Chain, TwoSlidesAreAStage) {
  const Arm arm{stage()};
  EXPECT_EQ(arm.joints(), 2U);
  // (0.1, 0, 0.2) + 0.01 up + (0, 0.05, 0) + 0.02 along x + tip; the axis of length 2 was made a unit.
  EXPECT_LT((arm.tip({0.01, 0.02}).e() - Vec3(0.15, 0.05, 0.21)).norm(), 1e-15);
  EXPECT_LT((arm.jacobian({}) - (Mat3() << 0, 1, 0, 0, 0, 0, 1, 0, 0).finished()).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(arm.dexterity(arm.jacobian({})), 1.0);
  const PerJoint weight = arm.gravity({}, 0.1, Payload::published);
  EXPECT_NEAR(weight[0], (0.5 + 0.2 + 0.1) * kStandardGravity, 1e-12);
  EXPECT_NEAR(weight[1], 0.0, 1e-12);
  // Rotors count with the square of the ratio: 1e-6 * 100^2 = 0.01 kg and 1e-6 * 200^2 = 0.04 kg.
  const Mat3 M = arm.mass({}, 0.1);
  EXPECT_NEAR(M(0, 0), 0.81, 1e-12);
  EXPECT_NEAR(M(1, 1), 0.34, 1e-12);
  EXPECT_NEAR(M(0, 1), 0.0, 1e-12);
  // The machine can neither push nor be pushed sideways.
  const PerJoint torque = arm.torque(arm.jacobian({}), Vec<'R'>(3, 7, 5));
  EXPECT_LT((arm.force(arm.jacobian({}), torque).e() - Vec3(3, 0, 5)).norm(), 1e-12);
  PerJoint q{};
  ASSERT_TRUE(arm.inverse(Point<'R'>(0.15, 0.05, 0.21), q));
  EXPECT_NEAR(q[0], 0.01, 1e-8);
  EXPECT_NEAR(q[1], 0.02, 1e-8);
  ASSERT_TRUE(arm.inverse(Point<'R'>(0.15, 0.06, 0.21), q));  // beside its plane: the nearest point in it
  EXPECT_NEAR(q[0], 0.01, 1e-8);
  EXPECT_NEAR(q[1], 0.02, 1e-8);
  EXPECT_FALSE(arm.inverse(Point<'R'>(0.30, 0.05, 0.21), q));  // beyond its limit
}

TEST(Chain, OneHingeIsAPendulum) {
  ArmMachine m;
  m.kind = ArmKind::chain;
  m.links = {{"rod", JointKind::hinge, {0, -1, 0}, {0, 0, 0}, 0.3, {0.1, 0, 0}, {0, 2e-3, 0}}};
  m.tip = {0.2, 0, 0};
  m.drives[0] = {-1.0, 1.0, 10.0, 1e-6};
  const Arm arm{m};
  EXPECT_LT((arm.tip({0.5}).e() - 0.2 * Vec3(std::cos(0.5), 0, std::sin(0.5))).norm(), 1e-15);
  // (0.3 * 0.1 + 0.05 * 0.2) g cos q
  EXPECT_NEAR(arm.gravity({0.5}, 0.05, Payload::exact)[0], 0.04 * kStandardGravity * std::cos(0.5), 1e-15);
  // 0.3 * 0.1^2 + 2e-3 + 0.05 * 0.2^2 + 1e-6 * 10^2 = 3 + 2 + 2 + 0.1 g m^2
  EXPECT_NEAR(arm.mass({0.5}, 0.05)(0, 0), 7.1e-3, 1e-15);
  EXPECT_DOUBLE_EQ(arm.dexterity(arm.jacobian({0.5})), 1.0);
}

TEST(Arm, RefusesWhatCannotBe) {
  const auto refused = [](auto change) {
    ArmMachine m = stage();
    change(m);
    EXPECT_THROW(Arm{m}, Error);
  };
  refused([](ArmMachine& m) { m.links.clear(); });
  refused([](ArmMachine& m) { m.links.resize(4); });
  refused([](ArmMachine& m) { m.links[1].axis = {0, 0, 0}; });
  refused([](ArmMachine& m) { m.links[0].mass = -1.0; });
  refused([](ArmMachine& m) { m.drives[1].low = 1.0; });
  refused([](ArmMachine& m) { m.drives[0].ratio = 0.0; });
  refused([](ArmMachine& m) { m = {}, m.phantom.l2 = 0.0; });
  refused([](ArmMachine& m) { m = {}, m.phantom.m_be = -0.1; });
  refused([](ArmMachine& m) { m = {}, m.phantom.coupled_low = 2.0; });
  refused([](ArmMachine& m) { m = {}, m.phantom.l1 = kUnset; });
}

// The shape of an arm against its kinematics: it ends at the tip, and its links join.

const Pose<'W', 'R'> kBase(Quat(Eigen::AngleAxisd(0.4, Vec3(0.2, -0.5, 1.0).normalized())),
                           Vec3(0.1, -0.2, 0.3));
const std::array<PerJoint, 3> kPoses{{{0, 0, 0}, {0.5, 0.3, 0.2}, {-0.7, -0.4, 0.6}}};

Vec3 end_of(const ArmPart& part, double end) {
  return part.middle.e() + end * part.half.z() * part.axes.col(2);
}

// Return true if a rod of that radius has an end there.
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
    EXPECT_TRUE(ends_at(parts, kBase * Point<'R'>(elbow), 0.0045));             // forearm, at the elbow
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

// 1st-order filter and servo of one corner w, damping ratio 1/2, no delay, a pure spring k_h as hand:
//   k (s^2 + w s + w^2)(s + w) + k_h w^3 = 0  =>  s^3 + 2 w s^2 + 2 w^2 s + w^3 (1 + k_h / k) = 0
// Routh: 2 w * 2 w^2 > w^3 (1 + k_h / k)  <=>  k > k_h / 3.
TEST(LoopModel, AgreesWithRouthByHand) {
  const LoopModel loop{.hand_stiffness = 300.0,
                       .hand_damping = 0.0,
                       .filter_hz = 10.0,
                       .servo_hz = 10.0,
                       .servo_damping = 0.5,
                       .delay = 0.0};
  EXPECT_NEAR(lowest_stable_stiffness(loop), 100.0, 1e-6);
}

// Hand with a damper b: k_h w^3 becomes (b s + k_h) w^3. With B = b w / k, K = k_h / k:
//   s^3 + 2 w s^2 + (2 + B) w^2 s + (1 + K) w^3 = 0, stable for 2 (2 + B) > 1 + K  <=>  3 k > k_h - 2 b w.
// k_h = 300 N/m, b = 1 N s/m, w = 30 rad/s: k > (300 - 60) / 3 = 80 N/m.
TEST(LoopModel, HandDampingHelpsAsByHand) {
  constexpr double kHz = 30.0 / (2.0 * 3.14159265358979323846);
  const LoopModel loop{.hand_stiffness = 300.0,
                       .hand_damping = 1.0,
                       .filter_hz = kHz,
                       .servo_hz = kHz,
                       .servo_damping = 0.5,
                       .delay = 0.0};
  EXPECT_NEAR(lowest_stable_stiffness(loop), 80.0, 1e-6);
}

// Without a damper and without mass the characteristic equation contains only k_h / k.
TEST(LoopModel, ScalesWithAPureSpringHand) {
  LoopModel loop{.hand_stiffness = 130.0, .hand_damping = 0.0};
  const double once = lowest_stable_stiffness(loop);
  EXPECT_GT(once, 0.0);
  for (const double factor : {0.1, 2.0, 7.0}) {
    loop.hand_stiffness = 130.0 * factor;
    EXPECT_NEAR(lowest_stable_stiffness(loop), once * factor, 1e-9 * once * factor);
  }
}

// sources/hexapod 5, baseline: k_h 130 N/m, b_h 2.2 N s/m, f_s 15 Hz, zeta 0.8, n_d 4 cycles (+1), f_c 5 Hz
// -> 0.022 N/mm.
TEST(LoopModel, GivesTheLinearBoundaryOfTheFidelityBaseline) {
  const LoopModel loop{.hand_stiffness = 130.0,
                       .hand_damping = 2.2,
                       .filter_hz = 5.0,
                       .servo_hz = 15.0,
                       .servo_damping = 0.8,
                       .delay = 0.005};
  EXPECT_NEAR(lowest_stable_stiffness(loop), 22.0, 0.5);
}

// Without delay the grip's damper (4 N s/m) keeps the loop stable at every stiffness; delay ends that.
TEST(LoopModel, MoreDelayNeedsAStifferObject) {
  LoopModel loop{.delay = 0.0};
  double before = lowest_stable_stiffness(loop);
  EXPECT_EQ(before, 0.0);
  for (const double delay : {0.005, 0.010, 0.020}) {
    loop.delay = delay;
    const double floor = lowest_stable_stiffness(loop);
    EXPECT_GT(floor, before) << "delay " << delay << " s";
    before = floor;
  }
}

}  // namespace
}  // namespace enc
