// The structural hexapod: its position under load, the forces in its legs, its sensor.
#include "sim/bodies/legs.h"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/record/replay.h"
#include "tests/support/refusal.h"
#include "tests/support/twin.h"
#include "trial/measure/programme_measures.h"

namespace enc::test {
namespace {

constexpr double kGravity = 9.80665;
constexpr double kMoved = 2.5 + 0.91;  // kg

std::vector<std::string> structural(const std::vector<std::string>& more = {}) {
  std::vector<std::string> set = exact_force();
  for (const char* text : {"truth.hexapod.form=structural", "truth.force.quantum_N=1e-9",
                           "truth.force.torque_quantum_Nm=1e-9", "truth.hexapod.repeatability_um=0"})
    set.emplace_back(text);
  set.insert(set.end(), more.begin(), more.end());
  return set;
}
// The machine alone.
models::Setup bare(const std::vector<std::string>& more = {}) {
  models::Setup setup = models::load(scene_file("tennis_ball"), "sim", structural(more));
  setup.scene.user.reset();
  return setup;
}
void go(Twin& twin, const Vec3& from_zero, int ticks) {
  const Vec3 there = twin.world->machine->machine().zero().p() + from_zero;
  twin.rig.manipulator->command(Pose<'R', 'H'>(Quat::Identity(), there));
  for (int i = 0; i < ticks; ++i) twin.rig.clock->next();
}
void push(Twin& twin, const Vec3& force) {  // on H
  double* applied = twin.world->physics().data()->qfrc_applied;
  std::copy_n(force.data(), 3, applied);
}
Hexapod::Lengths leg_forces(const Twin& twin) {
  return Eigen::Map<const Hexapod::Lengths>(twin.world->truth().leg_force.data());
}

TEST(Legs, TheWeightIsCalibratedOutAtZero) {
  Twin twin(1, bare());
  EXPECT_LT(twin.world->truth().tip.e().norm(), 1e-12);
  go(twin, Vec3::Zero(), 500);
  EXPECT_LT(twin.world->truth().tip.e().norm(), 1e-10);
  EXPECT_LT(twin.world->truth().tip_acceleration.norm(), 1e-6);
}

// All six legs are alike at zero: each carries a sixth of the weight over the cosine of its tilt.
TEST(Legs, CarryTheWeight) {
  Twin twin(1, bare());
  go(twin, Vec3::Zero(), 500);
  const Hexapod& machine = twin.world->machine->machine();
  const double tilt = std::acos(machine.geometry().height / machine.zero_length());
  for (int leg = 0; leg < 6; ++leg)
    EXPECT_NEAR(leg_forces(twin)(leg), kMoved * kGravity / 6.0 / std::cos(tilt), 1e-6);
}

TEST(Legs, SagAsTheirStiffnessSays) {
  Twin twin(1, bare());
  const double kz = twin.world->legs->stiffness()(2, 2);
  // Six legs, each with the square of its cosine.
  const Hexapod& machine = twin.world->machine->machine();
  const double cosine = machine.geometry().height / machine.zero_length();
  EXPECT_NEAR(kz, 6.0 * 2e6 * cosine * cosine, 1.0);
  push(twin, Vec3(0, 0, -50));
  go(twin, Vec3::Zero(), 1000);
  EXPECT_NEAR(-twin.world->truth().tip.xyz[2], 50.0 / kz, 0.005 * 50.0 / kz);
  // The machine's encoders report the servo's side.
  EXPECT_EQ(twin.rig.manipulator->read({}).value.X_RH.xyz, machine.zero().xyz);
  const Eigen::Matrix<double, 6, 6> J = machine.jacobian(machine.zero());
  const Eigen::Matrix<double, 6, 1> wrench = J.transpose() * leg_forces(twin);
  EXPECT_NEAR(wrench(2), kMoved * kGravity + 50.0, 0.01);  // legs turn slightly under the load
  EXPECT_NEAR(wrench.head<2>().norm(), 0.0, 0.01);
}

// Away from zero this weight bears on legs with other tilts. With the legs' forces of zero, f, and the weight
// W the machine is off by (J^T K J)^-1 (W + J^T f): some micrometres, mostly by its tilt.
TEST(Legs, AwayFromZeroTheCalibrationIsOffByWhatTheLeanSays) {
  Twin twin(1, bare());
  const Hexapod& machine = twin.world->machine->machine();
  const double each = kMoved * kGravity / 6.0 * machine.zero_length() / machine.geometry().height;
  go(twin, Vec3(0.03, -0.02, 0.01), 4000);
  const Pose<'R', 'H'> servo = twin.world->machine->state().pose;
  const Eigen::Matrix<double, 6, 6> J = machine.jacobian(servo);
  Eigen::Matrix<double, 6, 1> wrench = J.transpose() * Hexapod::Lengths::Constant(each);
  wrench(2) -= kMoved * kGravity;
  const Eigen::Matrix<double, 6, 1> expected = (2e6 * J.transpose() * J).partialPivLu().solve(wrench);
  const Vec3 off = twin.world->truth().tip.e() - (servo.p() - machine.zero().p());
  EXPECT_GT(off.norm(), 5e-6);
  EXPECT_LT((off - expected.head<3>()).norm(), 0.02 * off.norm());
}

// The platform keeps up with the servo at a steady speed: set-points move within the step. Set-points held
// over the step would lag by half a step, 20 mm/s * 0.25 ms = 5 um; a damper to the ground would add c v / k
// = 1.1 um.
TEST(Legs, DoNotLagBehindTheServo) {
  Twin twin(1, bare({"truth.hexapod.step_um=0"}));
  const Vec3 zero = twin.world->machine->machine().zero().p();
  double worst = 0.0;
  for (int i = 0; i < 800; ++i) {
    twin.rig.manipulator->command(Pose<'R', 'H'>(Quat::Identity(), Vec3(zero + Vec3(0, 0, 20e-6 * i))));
    twin.rig.clock->next();
    if (i < 500) continue;
    const Vec3 servo = twin.world->machine->state().pose.p() - zero;
    worst = std::max(worst, (twin.world->truth().tip.e() - servo).norm());
  }
  EXPECT_NEAR(twin.world->truth().tip_velocity.xyz[2], 0.020, 1e-4);
  EXPECT_LT(worst, 0.5e-6);
}

TEST(Legs, SetPointsAreACubicOfTimeWithinTheStep) {
  Twin twin(1, bare());
  mjData* d = twin.world->physics().data();
  const mjModel* m = twin.world->physics().model();
  const double h = 0.0005;
  sim::LegMotion from{Hexapod::Lengths::Constant(0.16), Hexapod::Lengths::Constant(0.01)};
  sim::LegMotion to{Hexapod::Lengths::Constant(0.16 + 6e-6), Hexapod::Lengths::Constant(0.014)};
  twin.world->legs->drive(d, from, to, h);
  const double lead = twin.world->legs->damping() / 2e6, start = d->time;
  const auto control_at = [&](double s) {
    d->time = start + s;
    mj_forward(m, d);
    return d->ctrl[3];
  };
  EXPECT_NEAR(control_at(0), 0.16 + lead * 0.01, 1e-12);
  EXPECT_NEAR(control_at(h), 0.16 + 6e-6 + lead * 0.014, 1e-12);
  // Hermite: (u0 + u1) / 2 + h (v0 - v1) / 8 and 1.5 (u1 - u0) / h - (v0 + v1) / 4 in the middle.
  const double middle = 0.16 + 3e-6 + h * (0.01 - 0.014) / 8.0;
  const double rate = 1.5 * 6e-6 / h - (0.01 + 0.014) / 4.0;
  EXPECT_NEAR(control_at(h / 2), middle + lead * rate, 1e-12);
}

TEST(Legs, DampingIsOfALegWithASixthOfTheMass) {
  Twin twin(1, bare());
  EXPECT_NEAR(twin.world->legs->damping(), 2.0 * 0.05 * std::sqrt(2e6 * kMoved / 6.0), 1e-9);
}

// The sensor of a free body feels inertia by itself: contact + m g - m a, with no term twice and none
// missing.
TEST(Legs, TheForceSensorFeelsWeightAndInertiaOnce) {
  Twin twin(1, bare());
  go(twin, Vec3::Zero(), 300);
  EXPECT_NEAR(twin.rig.force->read({}).value.force.xyz[2], -0.91 * kGravity, 1e-5);
  double largest = 0.0;
  for (int i = 0; i < 300; ++i) {
    go(twin, Vec3(0.010, 0, 0.005), 1);
    const sim::Truth& truth = twin.world->truth();
    largest = std::max(largest, truth.tip_acceleration.norm());
    // The platform turns by less than 0.1 mrad; the load behind the sensor has its centre 80 mm under H.
    const mjData* d = twin.world->physics().data();
    const Vec3 spin(d->qacc[3], d->qacc[4], d->qacc[5]);
    const Vec3 a = truth.tip_acceleration.e() + spin.cross(Vec3(0, 0, -0.08));
    const Vec3 expected = 0.91 * (Vec3(0, 0, -kGravity) - a);
    ASSERT_LT((twin.rig.force->read({}).value.force.e() - expected).norm(), 2e-3) << i;
  }
  EXPECT_GT(largest, 0.3);
}

TEST(Legs, APayloadSagsVibratesAndHolds) {
  Twin twin(1, bare({"truth.structure.payload_kg=10"}));
  const double kz = twin.world->legs->stiffness()(2, 2);
  go(twin, Vec3::Zero(), 2000);
  EXPECT_NEAR(-twin.world->truth().tip.xyz[2], 10 * kGravity / kz, 0.01 * 10 * kGravity / kz);
  push(twin, Vec3(0, 0, -100));
  go(twin, Vec3(0.02, 0.02, 0), 2000);
  EXPECT_EQ(twin.world->diverged_at(), -1);
  EXPECT_LT(leg_forces(twin).cwiseAbs().maxCoeff(), 171.0);
}

TEST(Legs, ATurnedBaseStandsAndHangsJustTheSame) {
  Twin twin(1, bare({"truth.hexapod.turned_deg=[3,-2,4]"}));
  go(twin, Vec3::Zero(), 500);
  EXPECT_LT(twin.world->truth().tip.e().norm(), 1e-9);
  const Hexapod& machine = twin.world->machine->machine();
  const Eigen::Matrix<double, 6, 6> J = machine.jacobian(machine.zero());
  const Eigen::Matrix<double, 6, 1> wrench = J.transpose() * leg_forces(twin);
  EXPECT_NEAR(wrench.head<3>().norm(), kMoved * kGravity, 1e-4);
}

// Also returns the place of the platform after these ticks.
std::pair<std::uint64_t, double> hashed_with_place(Twin& twin, int ticks) {
  const std::uint64_t hash = hashed(twin, ticks);
  return {hash, twin.world->physics().data()->qpos[0]};
}

TEST(Legs, GoOnFromASavedStateToTheBit) {
  const std::vector<std::string> set{"truth.hexapod.form=structural", "user.approach_mm_s=[50]",
                                     "user.approach_from_mm=30", "user.press_s=1"};
  Twin twin(set);
  twin.run(1700);
  const auto saved = twin.world->save();
  const Inputs in = twin.in;
  const State state = twin.state;
  const Outputs out = twin.out;
  const auto first = hashed_with_place(twin, 400);
  const auto forces = twin.world->truth().leg_force;
  EXPECT_GT(twin.world->truth().contact_force.norm(), 0.1);
  twin.world->restore(saved);
  twin.in = in;
  twin.state = state;
  twin.out = out;
  EXPECT_EQ(hashed_with_place(twin, 400), first);
  EXPECT_EQ(twin.world->truth().leg_force, forces);
  Twin other(set);  // and from the start
  other.run(1700);
  EXPECT_EQ(hashed_with_place(other, 400), first);
}

TEST(Legs, APressIsOneContactAndNoHold) {
  Twin twin({"truth.hexapod.form=structural", "user.approach_mm_s=[50]", "user.approach_from_mm=30",
             "user.press_s=1", "user.release_s=1"});
  double deepest = 0.0;
  while (!twin.world->user_done()) {
    twin.tick();
    ASSERT_NE(twin.out.mode, Mode::hold) << why_text(twin.out.why);
    deepest = std::max(deepest, twin.out.deflection);
  }
  EXPECT_EQ(twin.out.contacts, 1);
  EXPECT_GT(deepest, 0.0055);
  EXPECT_EQ(twin.world->diverged_at(), -1);
}

// Both forms in one process, ticked in turn: the legs' control belongs to its own world.
TEST(Legs, TwoWorldsDoNotDisturbEachOther) {
  Twin alone(1, bare());
  go(alone, Vec3(0.01, 0, 0), 300);
  Twin a(1, bare());
  Twin b(1, bare({"truth.structure.leg_stiffness_N_per_um=1"}));
  Twin control;
  for (int i = 0; i < 300; ++i) {
    go(a, Vec3(0.01, 0, 0), 1);
    go(b, Vec3(0, 0.01, 0), 1);
    control.tick();
  }
  EXPECT_EQ(a.world->truth().tip.xyz, alone.world->truth().tip.xyz);
  EXPECT_TRUE(std::isnan(control.world->truth().leg_force[0]));
}

// Arrivals at one command, in both forms: half a micrometre rms along each axis, unseen by the encoders.
TEST(Legs, ArrivalsRepeatToHalfAMicrometre) {
  for (const char* form : {"control", "structural"}) {
    Twin twin(1, bare({"truth.hexapod.repeatability_um=0.5", std::string("truth.hexapod.form=") + form}));
    sim::Stream random(5, "test");
    double sum = 0.0;
    constexpr int kArrivals = 40;
    for (int i = 0; i < kArrivals; ++i) {
      go(twin, 30e-6 * random.normal3().normalized(), 100);
      go(twin, Vec3::Zero(), 300);
      sum += twin.world->truth().tip.e().squaredNorm();
      const Vec3 said = twin.rig.manipulator->read({}).value.X_RH.p();
      EXPECT_LT((said - twin.world->machine->machine().zero().p()).norm(), 1e-8);
    }
    EXPECT_NEAR(std::sqrt(sum / (3 * kArrivals)), 0.5e-6, 4.0 * 0.5e-6 / std::sqrt(6.0 * kArrivals)) << form;
  }
}

std::string refused_legs(const std::vector<std::string>& set) {
  return test::refusal([&] { const Twin twin(set); });
}

TEST(Legs, BadInput) {
  EXPECT_NE(refused_legs({"truth.hexapod.form=structurl"}).find("did you mean 'structural'"),
            std::string::npos);
  EXPECT_NE(refused_legs({"truth.hexapod.form=structural", "truth.structure.timestep_us=300"})
                .find("haptic period"),
            std::string::npos);
  EXPECT_NE(refused_legs({"truth.structure.integrator=rk5"}).find("rk4"), std::string::npos);
  // The fastest mode grows with the root of the stiffness: 40 N/um need a smaller step.
  EXPECT_NE(refused_legs({"truth.hexapod.form=structural", "truth.structure.leg_stiffness_N_per_um=100"})
                .find("expected a time step of at most"),
            std::string::npos);
  EXPECT_EQ(refused_legs({"truth.structure.timestep_us=300"}), "");  // concerns only the structural form
}

// The test rig as a whole: machine, ball, sensor, programme.

struct PushResult {
  trial::TrialResult result;
  std::vector<trial::PushFigures> pushes;
  double spread = 0.0, force_error = 0.0;
};
PushResult run(const std::string& scene, const std::vector<std::string>& set = {}, std::uint64_t seed = 1) {
  trial::ProbeMeasure measure;
  trial::TrialOptions options{.seed = seed};
  options.watch = [&](const trial::Glance& glance) { measure.see(glance); };
  trial::Trial trial(models::load(scene_file(scene), "sim", set), options);
  const trial::TrialResult result = trial.run();
  return {result, measure.pushes(), measure.spread(), measure.force_error()};
}

// Run until a push is about this deep.
void run_to(Twin& twin, double depth) {
  for (int i = 0; i < 20'000 && twin.world->truth().penetration != depth; ++i) {
    twin.tick();
    if (twin.world->truth().penetration >= depth) return;
  }
}

// The force acts on the body behind the sensor: with weight and inertia it is the sensor's whole reading.
TEST(Rig, SensorReadsTheBallPlusWeight) {
  std::vector<std::string> set = exact_force();
  for (const char* text : {"truth.force.quantum_N=1e-12", "truth.force.torque_quantum_Nm=1e-12"})
    set.emplace_back(text);
  Twin twin(set, 1, "rig_B");
  double strongest = 0.0;
  for (int i = 0; i < 6000; ++i) {
    twin.tick();
    const sim::Truth& truth = twin.world->truth();
    const double mass = twin.setup.twin.hexapod.mass;
    const Vec3 expected =
        truth.contact_force.e() + mass * (Vec3(0, 0, -9.80665) - truth.tip_acceleration.e());
    if (i > 0) {
      ASSERT_LT((twin.in.wrench.value.force.e() - expected).norm(), 4e-6 + 2e-6 * expected.norm()) << i;
    }
    // Moments about F come from the force at the touched point; the weight has no lever while the machine
    // does not tilt.
    if (twin.world->truth().penetration > 0.001) {
      const Vec3 lever = (twin.world->ball->state().touched - truth.tip).e() + Vec3(0, 0, 0.127);
      ASSERT_LT((twin.in.wrench.value.torque.e() - lever.cross(truth.contact_force.e())).norm(), 1e-5) << i;
    }
    strongest = std::max(strongest, truth.contact_force.norm());
  }
  EXPECT_GT(strongest, 9.0);
}

// The sensor reads ten newtons at rest as ten newtons.
TEST(Rig, AStaticPushIsReadAsItIs) {
  std::vector<std::string> set = exact_force();
  for (const char* text : {"probe.dwell_s=3", "truth.ball.relaxing_fast=0", "truth.ball.relaxing_middle=0",
                           "truth.ball.relaxing_slow=0", "truth.force.quantum_N=1e-12"})
    set.emplace_back(text);
  Twin twin(set, 1, "rig_A");
  while (recall<IndentationState>(twin.state).phase != ProbePhase::dwell && twin.now() < 20.0) twin.tick();
  twin.run(2000);
  const double force = -twin.world->truth().contact_force.xyz[2];
  EXPECT_GT(force, 10.0);
  EXPECT_LT(force, 12.0);
  EXPECT_NEAR(-twin.out.force_unfiltered.xyz[2], force, 1e-4);
  EXPECT_NEAR(twin.out.force.xyz[2], force, 1e-4);  // N's z is the direction of the push's force on the probe
}

TEST(Rig, FivePushesOfEachSet) {
  for (const char* name : {"nominal", "low_loss", "high_loss", "vented", "kpa_20"}) {
    const PushResult made = run("rig_A", {std::string("truth.ball.set=") + name});
    ASSERT_EQ(made.pushes.size(), 5U) << name;
    for (const trial::PushFigures& push : made.pushes) {
      EXPECT_NEAR(push.peak_force, 12.0, 0.2) << name;
      EXPECT_NEAR(push.peak_deflection, 0.006, 0.1e-3) << name;
    }
    EXPECT_LT(made.spread, 0.2) << name;
    EXPECT_LT(made.force_error, 0.2) << name;
    EXPECT_NE(made.result.last_mode, Mode::hold) << name;
    EXPECT_TRUE(made.result.holds.empty()) << name;
  }
  const PushResult regulation = run("rig_A", {"truth.ball.set=regulation"});
  ASSERT_EQ(regulation.pushes.size(), 5U);
  for (const trial::PushFigures& push : regulation.pushes) {
    EXPECT_GT(push.peak_force, 45.0);
    EXPECT_LT(push.peak_force, 52.0);
  }
}

TEST(Rig, SameSeedSameHashOtherSeedOther) {
  const std::vector<std::string> quick{"probe.repeats=1"};
  const std::uint64_t first = run("rig_C", quick).result.hash;
  EXPECT_EQ(run("rig_C", quick).result.hash, first);
  EXPECT_NE(run("rig_C", quick, 2).result.hash, first);
}

TEST(Rig, GoesOnFromTheMiddleOfAPushToTheBit) {
  Twin twin({}, 1, "rig_B");
  run_to(twin, 0.003);
  ASSERT_GT(twin.world->truth().contact_force.norm(), 3.0);
  const auto saved = twin.world->save();
  const Inputs in = twin.in;
  const State state = twin.state;
  const Outputs out = twin.out;
  const std::uint64_t first = hashed(twin, 1500);
  const Vec<'W'> force = twin.world->truth().contact_force;
  twin.world->restore(saved);
  twin.in = in;
  twin.state = state;
  twin.out = out;
  EXPECT_EQ(hashed(twin, 1500), first);
  EXPECT_EQ(twin.world->truth().contact_force.xyz, force.xyz);
}

// A misplaced ball is touched at another moment; the machine pushes in either case.
TEST(Rig, AMisplacedBallIsTouchedLater) {
  Twin twin({"truth.ball.misplaced_mm=[0,0,1]"}, 1, "rig_A");
  run_to(twin, 1e-6);
  EXPECT_NEAR(twin.out.deflection, 0.001, 1e-5);
}

}  // namespace
}  // namespace enc::test
