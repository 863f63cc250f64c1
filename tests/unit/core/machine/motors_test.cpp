// The force that the motors of an arm can give, against the simulated motors.
#include "core/machine/motors.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/control/task/impedance/impedance.h"
#include "core/spec/rendering_rig.h"
#include "sim/plants/arm_plant.h"

namespace enc {
namespace {

constexpr double kTick = 1e-3;

struct Pose3 {
  PerJoint q{};
  Vec<'R'> way;
};

// Seeded poses of the arm's workspace, and directions of push.
Pose3 drawn(std::mt19937_64& random, const Arm& arm) {
  const auto in = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (;;) {
    Pose3 pose;
    pose.q = {in(-0.8, 0.8), in(-0.5, 0.8), in(-0.3, 1.0)};
    if (arm.within_limits(pose.q) && arm.dexterity(arm.jacobian(pose.q)) > 0.15) {
      Vec3 way(in(-1, 1), in(-1, 1), in(-1, 1));
      pose.way = Vec<'R'>(Vec3(way.normalized()));
      return pose;
    }
  }
}

// The plant, thermal alone: the joints are held in place.
bool clips(const Arm& arm, const Pose3& pose, double force, double tick, int ticks) {
  sim::ArmTruth truth;
  truth.velocity_window = tick;
  truth.watchdog = 1.0;
  sim::ArmPlant plant(truth, arm, tick);
  const Mat3 J = arm.jacobian(pose.q);
  const Vec<'R'> gravity = arm.force(J, arm.gravity(pose.q, 0.0, Payload::exact));
  for (int i = 0; i < ticks; ++i) {
    plant.measure(Time(Duration(i)), pose.q);
    plant.command(gravity + force * pose.way);
    plant.begin_cycle();
    if (plant.state().clipped) return true;
  }
  return false;
}

double strongest(const Arm& arm, const Pose3& pose, double tick, int ticks) {
  double low = 0.0, high = 40.0;
  for (int i = 0; i < 12; ++i) {
    const double middle = 0.5 * (low + high);
    (clips(arm, pose, middle, tick, ticks) ? high : low) = middle;
  }
  return high;
}

TEST(Motors, TheNamedForceIsTheSimulatedOneOverFiftyPoses) {
  const ArmRig rig;
  const Arm arm(rig.machine);
  const Motors motors(arm, motor_ratings(rig), kTick);
  std::mt19937_64 random(1);
  for (int i = 0; i < 50; ++i) {
    const Pose3 pose = drawn(random, arm);
    const PerJoint held = arm.gravity(pose.q, 0.0, Payload::exact);
    const Motors::Strength named = motors.strength(arm, pose.q, held, pose.way);
    EXPECT_NEAR(named.peak, std::min(rig.peak, strongest(arm, pose, kTick, 5)), 0.1 * named.peak) << i;
    EXPECT_NEAR(named.lasting, std::min(rig.peak, strongest(arm, pose, 0.5, 10'000)), 0.1 * named.lasting)
        << i;
  }
}

// The motor bears a load, tick by tick, until fold-back gives less than that load, not until the motor is
// warm.
TEST(Motors, AColdMotorBearsALoadAsLongAsItSays) {
  const ThermalModel thermal;
  constexpr double kPeak = 4.5, kStep = 0.01;
  for (const double load : {1.2, 2.0, 3.0, 4.4}) {
    const double time = bears_for(thermal, load, folds_at(load, kPeak, 1.0));
    double winding = 0.0, housing = 0.0;
    const MotorHeating warming(thermal, kStep);
    int ticks = 0;
    for (; folded_back(winding + housing, kPeak, 1.0) >= load; ++ticks) warming(load, winding, housing);
    EXPECT_NEAR(kStep * ticks, time, 0.01 * time) << load;
  }
  EXPECT_TRUE(std::isinf(bears_for(thermal, 0.99, folds_at(0.99, kPeak, 1.0))));
}

TEST(Motors, PressesWithTooLittleRestGiveWayInALaterOne) {
  const ArmRig rig;
  const Arm arm(rig.machine);
  const Motors motors(arm, motor_ratings(rig), kTick);
  const Vec<'R'> up(0, 0, 1);
  const PerJoint q = arm.zero();
  const double force = 0.9 * motors.strength(arm, q, {}, up).peak;
  const double holds = motors.holds_for(arm, q, {}, up, force);
  ASSERT_TRUE(std::isfinite(holds));
  EXPECT_EQ(motors.gives_way_in(arm, q, {}, up, force, {1.1 * holds, 100.0, 1}), 1);
  EXPECT_EQ(motors.gives_way_in(arm, q, {}, up, force, {0.8 * holds, 0.1, 1}), 0);
  EXPECT_EQ(motors.gives_way_in(arm, q, {}, up, force, {0.8 * holds, 0.1, 4}), 2);
  EXPECT_EQ(motors.gives_way_in(arm, q, {}, up, force, {0.8 * holds, 100.0, 2}), 0);
  // A load that the motor holds continuously gives infinity.
  EXPECT_TRUE(std::isinf(motors.holds_for(arm, q, {}, up, 0.999 * motors.strength(arm, q, {}, up).lasting)));
}

TEST(Motors, TheShareKeepsEachMotorWithinWhatItHas) {
  const ArmRig rig;
  const Arm arm(rig.machine);
  const Motors motors(arm, motor_ratings(rig), kTick);
  Heat heat;
  MotorLimit limit = MotorLimit::none;
  EXPECT_EQ(motors.share(heat, {}, {0.1, 0.1, 0.1}, limit), 1.0);
  EXPECT_EQ(limit, MotorLimit::none);
  EXPECT_NEAR(motors.share(heat, {}, {0.0, 2.0, 0.0}, limit), 0.129 * 7.47 / 2.0, 1e-12);
  EXPECT_EQ(limit, MotorLimit::peak);
  heat.winding[1] = 1.0;
  EXPECT_NEAR(motors.share(heat, {0.0, 0.05, 0.0}, {0.0, 2.0, 0.0}, limit), (0.0286 * 7.47 - 0.05) / 2.0,
              1e-12);
  EXPECT_EQ(limit, MotorLimit::heat);
}

}  // namespace
}  // namespace enc
