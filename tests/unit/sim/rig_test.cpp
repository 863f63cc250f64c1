// The test rig as a whole: machine, ball, sensor, programme.
#include <gtest/gtest.h>

#include "core/record/replay.h"
#include "tests/conformance/bench_world.h"
#include "trial/measure/probe_measure.h"

namespace enc::test {
namespace {

struct Pushed {
  trial::TrialResult result;
  std::vector<trial::PushFigures> pushes;
  double spread = 0.0, force_error = 0.0;
};
Pushed run(const std::string& scene, const std::vector<std::string>& set = {}, std::uint64_t seed = 1) {
  trial::ProbeMeasure measure;
  trial::TrialOptions options;
  options.seed = seed;
  options.watch = [&](const trial::Glance& glance) { measure.see(glance); };
  trial::Trial trial(models::load(scene_file(scene), "sim", set), options);
  const trial::TrialResult result = trial.run();
  return {result, measure.pushes(), measure.spread(), measure.force_error()};
}

// Ticks until a push is about so deep.
void run_to(Twin& twin, double depth) {
  for (int i = 0; i < 20'000 && twin.world->truth().penetration != depth; ++i) {
    twin.tick();
    if (twin.world->truth().penetration >= depth) return;
  }
}

// The force is put on the body behind the sensor: with weight and inertia it is all that the sensor reads.
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
    // About F: the force at the touched point; the weight has no lever while the machine does not tilt.
    if (twin.world->truth().penetration > 0.001) {
      const Vec3 lever = (twin.world->ball->state().touched - truth.tip).e() + Vec3(0, 0, 0.127);
      ASSERT_LT((twin.in.wrench.value.torque.e() - lever.cross(truth.contact_force.e())).norm(), 1e-5) << i;
    }
    strongest = std::max(strongest, truth.contact_force.norm());
  }
  EXPECT_GT(strongest, 9.0);
}

// Ten newtons at rest are read as ten newtons.
TEST(Rig, AStaticPushIsReadAsItIs) {
  std::vector<std::string> set = exact_force();
  for (const char* text : {"probe.dwell_s=3", "truth.ball.relaxing_fast=0", "truth.ball.relaxing_middle=0",
                           "truth.ball.relaxing_slow=0", "truth.force.quantum_N=1e-12"})
    set.emplace_back(text);
  Twin twin(set, 1, "rig_A");
  while (recall<Probing>(twin.state).phase != ProbePhase::dwell && twin.now() < 20.0) twin.tick();
  twin.run(2000);
  const double force = -twin.world->truth().contact_force.xyz[2];
  EXPECT_GT(force, 10.0);
  EXPECT_LT(force, 12.0);
  EXPECT_NEAR(-twin.out.felt.xyz[2], force, 1e-4);
  EXPECT_NEAR(twin.out.force.xyz[2], force, 1e-4);  // N's z is the way of the push's force on the probe
}

TEST(Rig, FivePushesOfEachSet) {
  for (const char* name : {"nominal", "low_loss", "high_loss", "vented", "kpa_20"}) {
    const Pushed made = run("rig_A", {std::string("truth.ball.set=") + name});
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
  const Pushed regulation = run("rig_A", {"truth.ball.set=regulation"});
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

// A ball that is not where the scene says is met at another moment; the machine pushes all the same.
TEST(Rig, AMisplacedBallIsTouchedLater) {
  Twin twin({"truth.ball.misplaced_mm=[0,0,1]"}, 1, "rig_A");
  run_to(twin, 1e-6);
  EXPECT_NEAR(twin.out.deflection, 0.001, 1e-5);
}

}  // namespace
}  // namespace enc::test
