// The gripper's phases by hand, and what the world and the core make of a clamped tool.
#include "sim/plants/gripper_plant.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/conformance/bench_world.h"

namespace enc::test {
namespace {

sim::GripperTruth exact() {
  sim::GripperTruth truth;
  truth.repeatability = 0.0;
  return truth;
}

struct Driven {
  explicit Driven(const sim::GripperTruth& truth, std::uint64_t seed = 1) : plant(truth, seed) {}
  const GripSample& run(int ticks) {
    for (int i = 0; i < ticks; ++i) plant.advance(Time(Duration(1'000'000LL * n++)), 1e-3);
    return plant.sample().value;
  }
  sim::GripperPlant plant;
  std::int64_t n = 0;
};

// 16 mm in 0.21 s: 76.19 um a tick; from 16 mm to 6 mm of tool: 131.25 ticks.
TEST(GripperPlant, ClosesAtItsSpeedUntilItMeetsTheTool) {
  Driven g(exact());
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
  Driven g(exact());
  g.plant.command({true, 80.0});
  g.run(60);
  g.plant.command({false, kUnset});
  EXPECT_EQ(g.run(1).phase, GripPhase::opening);
  EXPECT_NEAR(g.run(0).opening, 0.016 - 59 * 0.016 / 210.0, 1e-12);
  EXPECT_EQ(g.run(60).phase, GripPhase::open);
  EXPECT_DOUBLE_EQ(g.run(0).opening, 0.016);
}

TEST(GripperPlant, ClosesOnNothing) {
  sim::GripperTruth truth = exact();
  truth.width = 0.0;
  Driven g(truth);
  g.plant.command({true, 80.0});
  EXPECT_EQ(g.run(209).phase, GripPhase::closing);
  EXPECT_EQ(g.run(2).phase, GripPhase::closed);
  EXPECT_FALSE(g.run(0).holding);
  EXPECT_EQ(g.run(0).force, 0.0);
  EXPECT_EQ(g.run(0).opening, 0.0);
}

TEST(GripperPlant, ComesToStandWithItsRepeatability) {
  Driven g(sim::GripperTruth{}, 3);
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
    Stamped<TrackedTool> seen;
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

// The force sensor feels the tool's weight and inertia, the core takes both out.
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
  EXPECT_TRUE(twin.out.grip.closed);
  EXPECT_DOUBLE_EQ(twin.out.grip.force, 100.0);
  EXPECT_TRUE(twin.in.grip.value.holding);
}

TEST(ClampedTool, AnEmptyGripperMeansHoldAndStaysClosed) {
  Twin twin({"truth.gripper.width_mm=0"}, 1, "clamped_tool");
  twin.run(205);
  EXPECT_NE(twin.out.mode, Mode::hold);  // still closing
  twin.run(20);
  EXPECT_EQ(twin.out.mode, Mode::hold);
  EXPECT_NE(twin.out.why & kToolNotHeld, 0U);
  EXPECT_TRUE(twin.out.grip.closed);
}

TEST(ClampedTool, WithoutAGripperNothingIsBuiltOrWanted) {
  Twin twin;
  EXPECT_FALSE(twin.rig.gripper);
  EXPECT_FALSE(twin.world->gripper);
  twin.run(10);
  EXPECT_FALSE(twin.out.grip.closed);
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
  try {
    models::load(scene_file(scene), "sim", set);
  } catch (const Error& e) {
    return e.what();
  }
  return "(accepted)";
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
}  // namespace enc::test
