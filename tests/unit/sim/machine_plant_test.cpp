// The simulated machines and the gripper.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "sim/plants/arm_plant.h"
#include "sim/plants/device_plants.h"
#include "sim/plants/hexapod_plant.h"
#include "tests/support/refusal.h"
#include "tests/support/scenes.h"
#include "tests/support/twin.h"
#include "tests/unit/trial/runs.h"
#include "trial/trial.h"

namespace enc::sim {
namespace {

using test::exact_force, test::scene_file, test::Twin;

// The twin of the machine's position loop against its equation, and a simulated person against the strength
// of a hand.

// Second order: x = 1 - exp(-z w t) (cos u t + z w / u sin u t), u = w sqrt(1 - z^2).
double step_response(double servo, double damping, double t) {
  const double w = 2.0 * std::numbers::pi * servo, u = w * std::sqrt(1.0 - damping * damping);
  return 1.0 - std::exp(-damping * w * t) * (std::cos(u * t) + damping * w / u * std::sin(u * t));
}

TEST(HexapodPlant, AServoIsAsSlowAsItsEquationHoweverFastItIs) {
  for (const double servo : {15.0, 60.0, 300.0}) {
    HexapodTruth truth;
    truth.servo = servo;
    truth.delay_cycles = 0;
    truth.speed = truth.acceleration = 1e6;
    truth.step = truth.repeatability = 0.0;
    HexapodPlant machine(truth, 1);
    const Pose<'R', 'H'> from = machine.true_pose();
    machine.command({from.q(), Vec3(from.p() + Vec3(1e-3, 0, 0))});
    double worst = 0.0;
    for (int tick = 1; tick <= 100; ++tick) {
      machine.begin_cycle();
      machine.move(1e-3);
      const double moved = (machine.true_pose().p() - from.p()).x() / 1e-3;
      worst = std::max(worst, std::abs(moved - step_response(servo, truth.damping, 1e-3 * tick)));
    }
    EXPECT_LT(worst, 0.07) << servo << " Hz";
  }
}

// A hand presses a rigid object with its strength, not with its spring times the way.
TEST(User, PushesNoHarderThanAHandDoes) {
  trial::TrialOptions options{.seconds = 6.0};
  models::Setup setup = test::shipped("plane", {"user.depth_mm=400", "truth.hand.strength_N=20"});
  trial::Trial trial(std::move(setup), options);
  double most = 0.0;
  while (trial.tick())
    if (trial.outputs().mode == Mode::contact) most = std::max(most, trial.truth().contact_force.norm());
  EXPECT_GT(most, 10.0);
  EXPECT_LT(most, 30.0);  // and the weight of the tool, and the impact
}

// The arm's electronics, worked by hand: encoder resolution, motor limits, and stops.

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

// 4096 counts of a motor that turns 8.87 and 7.47 times: at q = 0 the tip moves along x, y, z with q3, q1,
// q2.
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

// 0.129 N m times 7.47 over 0.1397 m: 6.90 N upwards is the maximum, as in sources/arm 5.
TEST(ArmPlant, ClipsAtTheMotorsPeak) {
  Bench b;
  b.push({0, 0, 20});
  EXPECT_TRUE(b.plant.state().clipped);
  EXPECT_NEAR(b.plant.state().torque[1] / 0.1397, 6.90, 0.01);
  EXPECT_NEAR(b.plant.motor_torque()[1], 0.129, 1e-12);
  EXPECT_EQ(b.plant.motor_torque()[0], 0.0);
}

// A cold winding at stall torque reaches 0.8 of its rated heat when
// i^2 (s (1 - e^(-t/12)) + (1 - s)(1 - e^(-t/612))) = 0.8, i = 0.129 / 0.0286, s = 3.1 / 17.1: after 2.6 s.
// Then the current folds back smoothly, and the winding never exceeds its limit.
TEST(ArmPlant, AWarmWindingFoldsBackSmoothly) {
  Bench b;
  const double i2 = std::pow(0.129 / 0.0286, 2), share = 3.1 / 17.1;
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
  for (int i = 0; i < 200; ++i) b.plant.begin_cycle();  // no command: the watchdog stops it
  EXPECT_LT(b.plant.state().surface_speed, 1e-5);
}

TEST(ArmPlant, RefusesAVelocityWindowThatIsTooLong) {
  ArmTruth truth;
  truth.velocity_window = 0.1;
  EXPECT_THROW(Bench{truth}, Error);
}

// The gripper's phases by hand, and the effect of a clamped tool on world and core.

GripperTruth exact_gripper() {
  sim::GripperTruth truth{.repeatability = 0.0};
  return truth;
}

struct GripperRun {
  explicit GripperRun(const sim::GripperTruth& truth, std::uint64_t seed = 1) : plant(truth, seed) {}
  const GripSample& run(int ticks) {
    for (int i = 0; i < ticks; ++i) plant.advance(Time(Duration(1'000'000LL * n++)), 1e-3);
    return plant.sample().value;
  }
  sim::GripperPlant plant;
  std::int64_t n = 0;
};

// 16 mm in 0.21 s: 76.19 um a tick; from 16 mm to 6 mm of tool: 131.25 ticks.
TEST(GripperPlant, ClosesAtItsSpeedUntilItMeetsTheTool) {
  GripperRun g(exact_gripper());
  EXPECT_EQ(g.run(5).phase, GripPhase::open);
  EXPECT_DOUBLE_EQ(g.run(0).opening, 0.016);
  g.plant.command({true, 80.0});
  EXPECT_EQ(g.run(1).phase, GripPhase::closing);
  EXPECT_NEAR(g.run(0).opening, 0.016 - 0.016 / 210.0, 1e-12);
  EXPECT_EQ(g.run(130).phase, GripPhase::closing);
  EXPECT_EQ(g.run(0).force, 0.0);
  EXPECT_FALSE(g.run(0).holding);
  EXPECT_EQ(g.run(1).phase, GripPhase::closed);
  EXPECT_DOUBLE_EQ(g.run(0).opening, 0.006);
  EXPECT_TRUE(g.run(0).holding);
  EXPECT_DOUBLE_EQ(g.run(0).force, 80.0);
  g.plant.command({true, 120.0});  // harder, without opening
  EXPECT_DOUBLE_EQ(g.run(1).force, 120.0);
}

TEST(GripperPlant, OpensFromWhereItIs) {
  GripperRun g(exact_gripper());
  g.plant.command({true, 80.0});
  g.run(60);
  g.plant.command({false, kUnset});
  EXPECT_EQ(g.run(1).phase, GripPhase::opening);
  EXPECT_NEAR(g.run(0).opening, 0.016 - 59 * 0.016 / 210.0, 1e-12);
  EXPECT_EQ(g.run(60).phase, GripPhase::open);
  EXPECT_DOUBLE_EQ(g.run(0).opening, 0.016);
}

TEST(GripperPlant, ClosesOnNothing) {
  sim::GripperTruth truth = exact_gripper();
  truth.width = 0.0;
  GripperRun g(truth);
  g.plant.command({true, 80.0});
  EXPECT_EQ(g.run(209).phase, GripPhase::closing);
  EXPECT_EQ(g.run(2).phase, GripPhase::closed);
  EXPECT_FALSE(g.run(0).holding);
  EXPECT_EQ(g.run(0).force, 0.0);
  EXPECT_EQ(g.run(0).opening, 0.0);
}

TEST(GripperPlant, ComesToStandWithItsRepeatability) {
  GripperRun g(sim::GripperTruth{}, 3);
  double sum = 0.0;
  constexpr int kTimes = 400;
  for (int i = 0; i < kTimes; ++i) {
    g.plant.command({true, 80.0});
    const double off = g.run(250).opening - 0.006;
    sum += off * off;
    g.plant.command({false, kUnset});
    g.run(250);
  }
  EXPECT_NEAR(std::sqrt(sum / kTimes), 0.02e-3, 4.0 * 0.02e-3 / std::sqrt(2.0 * kTimes));
}

// ---- a clamped tool in the world --------------------------------------------------------------------------

TEST(ClampedTool, IsPartOfTheTipsBody) {
  Twin twin({}, 1, "clamped_tool");
  const mjModel* m = twin.world->physics().model();
  const int tool = mj_name2id(m, mjOBJ_BODY, "clamped_tool");
  ASSERT_GE(tool, 0);
  EXPECT_EQ(m->body_parentid[tool], mj_name2id(m, mjOBJ_BODY, "behind_sensor"));
  EXPECT_EQ(m->body_jntnum[tool], 0);
  EXPECT_EQ(m->neq, 0);
  EXPECT_DOUBLE_EQ(m->body_mass[tool], 0.05);
}

TEST(ClampedTool, TheTrackerSeesItMoveWithTheMachine) {
  for (const char* form : {"control", "structural"}) {
    Twin twin({"truth.tracker.noise_mm=[0,0,0]", "truth.tracker.marker_noise_mm=0",
               "truth.tracker.bias_mm=[0,0,0]", std::string("truth.hexapod.form=") + form},
              1, "clamped_tool");
    Measurement<TrackedTool> seen;
    const Vec3 way(0.010, -0.005, 0.008);
    const Vec3 there = twin.rig.manipulator->reach().machine.zero().p() + way;
    for (int i = 0; i < 2000; ++i) {
      twin.rig.clock->next();
      twin.rig.manipulator->command(Pose<'R', 'H'>(Quat::Identity(), there));
      twin.rig.tracker->poll({}, seen);
    }
    ASSERT_EQ(seen.health, Health::ok);
    EXPECT_EQ(seen.value.tool, 0);
    const Pose<'W', 'T'> X_WT = twin.scene.X_WC * seen.value.X_CT;
    const Vec3 tip = (X_WT * Point<'T'>(twin.setup.scene.tools[0].tip)).e();
    EXPECT_LT((tip - way).norm(), 6e-6) << form;  // its tip is at H; steps of 3 um, repeatability
    EXPECT_GT((X_WT.p() - tip).z(), 0.1);         // markers above
  }
}

// The force sensor feels the tool's weight and inertia, and the core removes both.
TEST(ClampedTool, IsTakenOutOfTheForce) {
  std::vector<std::string> set = exact_force();
  set.emplace_back("truth.force.quantum_N=1e-9");
  Twin twin(set, 1, "clamped_tool");
  EXPECT_DOUBLE_EQ(twin.scene.force.mass, 0.91 + 0.05);
  twin.run(10);
  EXPECT_NEAR(twin.in.wrench.value.force.xyz[2], -0.96 * 9.80665, 1e-4);
}

TEST(ClampedTool, IsNotFollowed) {
  Twin twin({}, 1, "clamped_tool");
  twin.run(2000);
  EXPECT_EQ(twin.in.tool.value.tool, 0);  // it is seen
  EXPECT_EQ(twin.out.mode, Mode::away);
  EXPECT_EQ(twin.out.contacts, 0);
  EXPECT_LT(twin.world->truth().tip.e().norm(), 5e-6);
  EXPECT_TRUE(twin.out.manipulator.grip.closed);
  EXPECT_DOUBLE_EQ(twin.out.manipulator.grip.force, 100.0);
  EXPECT_TRUE(twin.in.grip.value.holding);
}

TEST(ClampedTool, AnEmptyGripperMeansHoldAndStaysClosed) {
  Twin twin({"truth.gripper.width_mm=0"}, 1, "clamped_tool");
  twin.run(205);
  EXPECT_NE(twin.out.mode, Mode::hold);  // still closing
  twin.run(20);
  EXPECT_EQ(twin.out.mode, Mode::hold);
  EXPECT_NE(twin.out.why & kToolNotHeld, 0U);
  EXPECT_TRUE(twin.out.manipulator.grip.closed);
}

TEST(ClampedTool, WithoutAGripperNothingIsBuiltOrWanted) {
  Twin twin;
  EXPECT_FALSE(twin.rig.gripper);
  EXPECT_FALSE(twin.world->gripper);
  twin.run(10);
  EXPECT_FALSE(twin.out.manipulator.grip.closed);
  EXPECT_EQ(twin.in.grip.health, Health::absent);
}

TEST(ClampedTool, GoesOnFromASavedState) {
  Twin twin({}, 1, "clamped_tool");
  twin.run(100);  // jaws on their way
  const auto saved = twin.world->save();
  twin.run(100);
  const GripSample then = twin.world->gripper->sample().value;
  twin.world->restore(saved);
  twin.run(100);
  EXPECT_EQ(twin.world->gripper->sample().value.opening, then.opening);
  EXPECT_EQ(twin.world->gripper->sample().value.phase, then.phase);
}

std::string refused(const std::string& scene, const std::vector<std::string>& set) {
  return test::refusal([&] { models::load(scene_file(scene), "sim", set); });
}

TEST(ClampedTool, BadInput) {
  EXPECT_NE(refused("clamped_tool", {"gripper.tool=stilus"}).find("did you mean 'stylus'"),
            std::string::npos);
  EXPECT_NE(refused("clamped_tool", {"truth.gripper.width_mm=20"}).find("at most 16 mm"), std::string::npos);
  EXPECT_NE(refused("clamped_tool", {"truth.gripper.force_max_N=10"}).find("force_min_N"), std::string::npos);
  EXPECT_NE(refused("tennis_ball", {"gripper.tool=stylus"}).find("unknown parameter"), std::string::npos);
  models::Setup both = models::load(scene_file("tennis_ball"), "sim");
  both.scene.gripper.emplace();
  EXPECT_THROW(models::check(both), Error);  // one tool, held and clamped
}

}  // namespace
}  // namespace enc::sim
