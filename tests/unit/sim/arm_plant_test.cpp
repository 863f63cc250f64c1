// The arm's electronics, worked by hand: what encoders see, what motors can, when they stop.
#include "sim/plants/arm_plant.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace enc::sim {
namespace {

constexpr double kTick = 0.001;

struct Bench {
  explicit Bench(const ArmTruth& t = {}) : truth(t), arm(t.machine), plant(t, arm, kTick) { read({}); }
  void read(const PerJoint& q) { plant.measure(Time(from_seconds(kTick * n++)), q); }
  void push(const Vec3& force, int ticks = 1) {
    for (int i = 0; i < ticks; ++i) {
      plant.command(Vec<'R'>(force));
      plant.begin_cycle();
    }
  }
  ArmTruth truth;
  Arm arm;
  ArmPlant plant;
  int n = 0;
};

// 4096 counts of a motor that turns 8.87 and 7.47 times: at q = 0 the tip goes along x, y, z with q3, q1, q2.
TEST(ArmPlant, ResolvesTheTipAsTheCatalogueSays) {
  const Bench b;
  EXPECT_NEAR(b.plant.step(2) * 0.1130, 0.0232e-3, 0.0001e-3);
  EXPECT_NEAR(b.plant.step(0) * 0.1397, 0.0242e-3, 0.0001e-3);
  EXPECT_NEAR(b.plant.step(1) * 0.1397, 0.0287e-3, 0.0001e-3);
}

TEST(ArmPlant, CountsAndDifferences) {
  Bench b;
  const double step = b.plant.step(1);
  b.read({0, 0.49 * step, 0});
  EXPECT_EQ(b.plant.state().sample.value.joints[1], 0.0);
  b.read({0, 10.4 * step, 0});
  const ArmSample& s = b.plant.state().sample.value;
  EXPECT_DOUBLE_EQ(s.joints[1], 10.0 * step);
  EXPECT_NEAR(s.joint_velocities[1], 10.0 * step / 0.002, 1e-12);  // over the window of 2 ms
  EXPECT_NEAR(s.velocity.xyz[2], 0.1397 * s.joint_velocities[1], 1e-5);
  EXPECT_NEAR(s.tip.xyz[2], -0.1130 + 0.1397 * 10.0 * step, 1e-6);
  EXPECT_EQ(b.plant.state().sample.health, Health::ok);
}

TEST(ArmPlant, MakesTorqueOfForce) {
  Bench b;
  b.push({1.0, 2.0, 3.0});
  const PerJoint& torque = b.plant.state().torque;
  EXPECT_NEAR(torque[0], 2.0 * 0.1397, 1e-12);
  EXPECT_NEAR(torque[1], 3.0 * 0.1397, 1e-12);
  EXPECT_NEAR(torque[2], 1.0 * 0.1130, 1e-12);
  EXPECT_FALSE(b.plant.state().clipped);
}

// 0.129 N m times 7.47 over 0.1397 m: 6.90 N upwards is all there is, as sources/arm 5 says.
TEST(ArmPlant, ClipsAtTheMotorsPeak) {
  Bench b;
  b.push({0, 0, 20});
  EXPECT_TRUE(b.plant.state().clipped);
  EXPECT_NEAR(b.plant.state().torque[1] / 0.1397, 6.90, 0.01);
  EXPECT_NEAR(b.plant.motor_torque()[1], 0.129, 1e-12);
  EXPECT_EQ(b.plant.motor_torque()[0], 0.0);
}

// From cold, stall torque brings a winding to 0.8 of its rated heat where
// i^2 (s (1 - e^(-t/12)) + (1 - s)(1 - e^(-t/612))) = 0.8, i = 0.129 / 0.0286, s = 3.1 / 17.1: after 2.6 s.
// Then it folds back, smoothly, and never gets warmer than it may.
TEST(ArmPlant, AWarmWindingFoldsBackSmoothly) {
  Bench b;
  const double i2 = std::pow(0.129 / 0.0286, 2);
  const double share = 3.1 / 17.1;
  int ticks = 0;
  while (i2 * (share * -std::expm1(-ticks * kTick / 12.0) +
               (1.0 - share) * -std::expm1(-ticks * kTick / 612.0)) <
         0.8)
    ++ticks;
  EXPECT_NEAR(ticks * kTick, 2.6, 0.2);
  b.push({0, 0, 20}, ticks - 1);
  EXPECT_NEAR(b.plant.motor_torque()[1], 0.129, 1e-12);
  double before = b.plant.motor_torque()[1], leap = 0.0, warmest = 0.0;
  for (int i = 0; i < 120'000; ++i) {
    b.push({0, 0, 20});
    const double torque = b.plant.motor_torque()[1];
    leap = std::max(leap, std::abs(torque - before));
    before = torque;
    warmest = std::max(warmest, b.plant.warmth(1));
  }
  EXPECT_LT(leap, 0.5e-3);
  EXPECT_LT(warmest, 1.0);
  EXPECT_GT(warmest, 0.9);
  EXPECT_GT(before, 0.0286);
  EXPECT_LT(before, 0.050);
  EXPECT_EQ(b.plant.warmth(0), 0.0);
}

TEST(ArmPlant, TheWatchdogTakesTheForceAway) {
  Bench b;
  b.push({0, 0, 1});
  for (int i = 0; i < 5; ++i) b.plant.begin_cycle();
  EXPECT_GT(b.plant.state().torque[1], 0.1);
  b.plant.begin_cycle();
  EXPECT_EQ(b.plant.state().torque[1], 0.0);
  b.push({0, 0, 1});
  EXPECT_GT(b.plant.state().torque[1], 0.1);
}

TEST(ArmPlant, RefusesAForceThatIsNoNumber) {
  Bench b;
  b.push({0, 0, 1});
  b.plant.command(Vec<'R'>(0, kUnset, 0));
  EXPECT_EQ(b.plant.state().sample.health, Health::fault);
  b.plant.begin_cycle();
  EXPECT_NEAR(b.plant.state().torque[1], 0.1397, 1e-12);
  b.push({0, 0, 1});
  EXPECT_EQ(b.plant.state().sample.health, Health::ok);
}

TEST(ArmPlant, HasTwoFormsOfFriction) {
  ArmTruth truth;
  EXPECT_EQ(Bench(truth).plant.friction({1, 1, 1}), PerJoint{});  // dry: MuJoCo's
  truth.friction_form = ArmFriction::smooth;
  const PerJoint friction = Bench(truth).plant.friction({0.0, 0.1, -10.0});
  EXPECT_EQ(friction[0], 0.0);
  EXPECT_NEAR(friction[1], -0.01 * std::tanh(1.0), 1e-15);
  EXPECT_NEAR(friction[2], 0.01, 1e-15);
}

TEST(ArmPlant, TheGimbalTurnsInItsTime) {
  Bench b;
  b.plant.face(Vec3::UnitZ(), kTick, true);
  b.plant.face(Vec3::UnitX(), kTick, false);
  const double first = std::acos((b.plant.facing() * Vec3::UnitZ()).z());
  EXPECT_NEAR(first, 0.5 * std::numbers::pi * (1.0 - std::exp(-1.0 / 30.0)), 1e-9);
  for (int i = 0; i < 600; ++i) b.plant.face(Vec3::UnitX(), kTick, false);
  EXPECT_LT((b.plant.facing() * Vec3::UnitZ() - Vec3::UnitX()).norm(), 1e-6);
}

TEST(ArmPlant, ADrivenFrontComesUpToSpeed) {
  Bench b;
  b.plant.move_prop({.surface_speed = 0.05, .facing = {}});
  for (int i = 0; i < 20; ++i) {
    b.plant.command(Vec<'R'>::zero());
    b.plant.begin_cycle();
  }
  EXPECT_NEAR(b.plant.state().surface_speed, 0.05 * (1.0 - std::exp(-1.0)), 1e-9);
  for (int i = 0; i < 200; ++i) b.plant.begin_cycle();  // nobody commands: the watchdog stops it
  EXPECT_LT(b.plant.state().surface_speed, 1e-5);
}

TEST(ArmPlant, RefusesAVelocityWindowThatIsTooLong) {
  ArmTruth truth;
  truth.velocity_window = 0.1;
  EXPECT_THROW(Bench{truth}, Error);
}

}  // namespace
}  // namespace enc::sim
