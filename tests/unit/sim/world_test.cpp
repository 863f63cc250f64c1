// The twin as a whole: what its sensor reads, that it can be saved, that it is nobody else's business.
#include "sim/world.h"

#include <cstring>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/record/state_hash.h"
#include "tests/conformance/bench_world.h"

namespace enc::test {
namespace {

// Quick to the touch: one press at 50 mm/s from 30 mm straight above.
std::vector<std::string> quick() {
  std::vector<std::string> set = exact_force();
  for (const char* text :
       {"user.approach_mm_s=[50]", "user.approach_from_mm=30", "user.press_s=2", "user.approach_tilt_deg=0"})
    set.emplace_back(text);
  return set;
}

// Puts the tool's tip at a place, at a speed, by writing MuJoCo's state.
void put_tool(Twin& twin, const Vec3& p, const Vec3& v) {
  const mjModel* model = twin.world->physics().model();
  mjData* data = twin.world->physics().data();
  const int joint = model->body_jntadr[mj_name2id(model, mjOBJ_BODY, "tool")];
  std::copy_n(p.data(), 3, data->qpos + model->jnt_qposadr[joint]);
  std::copy_n(v.data(), 3, data->qvel + model->jnt_dofadr[joint]);
}

bool same_bits(const sim::Truth& a, const sim::Truth& b) {
  return a.t == b.t && a.press == b.press && a.phase == b.phase && a.touching == b.touching &&
         a.tool_tip.xyz == b.tool_tip.xyz && a.tool_velocity.xyz == b.tool_velocity.xyz &&
         a.tip.xyz == b.tip.xyz && a.tip_velocity.xyz == b.tip_velocity.xyz &&
         a.contact_force.xyz == b.contact_force.xyz && a.hand_force.xyz == b.hand_force.xyz;
}

TEST(World, SensorReadsContactPlusWeight) {
  std::vector<std::string> set = quick();
  for (const char* text : {"truth.force.quantum_N=1e-12", "truth.force.torque_quantum_Nm=1e-12"})
    set.emplace_back(text);
  Twin twin(set);
  const double g = -twin.world->physics().model()->opt.gravity[2];
  double strongest = 0.0;
  for (int i = 0; i < 4000; ++i) {
    twin.tick();
    const sim::Truth& truth = twin.world->truth();
    const Vec3 carried = twin.setup.twin.hexapod.mass * (Vec3(0, 0, -g) - truth.tip_acceleration.e());
    const Vec3 expected =
        truth.contact_force.e() + carried;  // the machine does not tilt here: F is turned as W
    if (i > 0) {
      // The platform is a body of 1e6 kg: a millionth of the load on 0.91 kg is missing.
      ASSERT_LT((twin.in.wrench.value.force.e() - expected).norm(), 4e-6 + 1e-6 * expected.norm())
          << "tick " << i;
    }
    strongest = std::max(strongest, truth.contact_force.norm());
  }
  EXPECT_GT(strongest, 5.0);  // there was a press
}

TEST(World, GoesOnFromASavedStateToTheBit) {
  Twin twin(quick());
  twin.run(2000);
  const auto saved = twin.world->save();
  const Inputs in = twin.in;
  const State state = twin.state;
  const Outputs out = twin.out;
  const std::uint64_t first = hashed(twin, 500);
  const sim::Truth truth = twin.world->truth();
  twin.world->restore(saved);
  twin.in = in;
  twin.state = state;
  twin.out = out;
  EXPECT_EQ(hashed(twin, 500), first);
  EXPECT_TRUE(same_bits(twin.world->truth(), truth));
  EXPECT_EQ(twin.k.index, 2499);
}

TEST(World, ASavedStateThatIsCutOrForeignIsRefused) {
  Twin twin;
  auto saved = twin.world->save();
  saved.resize(saved.size() / 2);
  EXPECT_THROW(twin.world->restore(saved), Error);
  Twin plane({}, 1, "plane");
  EXPECT_THROW(plane.world->restore(twin.world->save()), Error);
}

TEST(World, TwoInOneProcessDoNotDisturbEachOther) {
  Twin alone(quick());
  const std::uint64_t expected = hashed(alone, 1500);
  Twin a(quick());
  Twin b(quick(), 2);
  StateHash hash;
  for (int i = 0; i < 1500; ++i) {
    a.tick();
    add_tick(hash, a.state, a.out);
    b.tick();
  }
  EXPECT_EQ(hash.value, expected);
}

TEST(World, SeedChangesTheNumbersAndOnlyTheSeed) {
  Twin a({}, 3);
  Twin b({}, 3);
  Twin c({}, 4);
  const std::uint64_t first = hashed(a, 700);
  EXPECT_EQ(hashed(b, 700), first);
  EXPECT_NE(hashed(c, 700), first);
}

// One random stream for each device: another device changes nobody's numbers.
TEST(World, ADisplayChangesNoForceAndNoTrackerSample) {
  models::Setup without = models::load(scene_file("tennis_ball"), "sim");
  without.scene.display.reset();
  Twin with;
  Twin bare(1, without);
  ASSERT_FALSE(bare.rig.display);
  Stamped<TrackedTool> a;
  Stamped<TrackedTool> b;
  for (int i = 0; i < 1000; ++i) {
    with.rig.clock->next();
    bare.rig.clock->next();
    ASSERT_EQ(with.rig.force->read({}).value.force.xyz, bare.rig.force->read({}).value.force.xyz);
    const bool news = with.rig.tracker->poll({}, a);
    ASSERT_EQ(bare.rig.tracker->poll({}, b), news);
    if (news) {
      ASSERT_EQ(a.value.X_CT.xyz, b.value.X_CT.xyz);
    }
  }
}

TEST(World, DivergenceIsReportedWithItsTickAndTimeGoesOn) {
  Twin twin;
  EXPECT_NE(twin.world->physics().model()->opt.disableflags & mjDSBL_AUTORESET, 0);
  twin.run(100);
  EXPECT_EQ(twin.world->diverged_at(), -1);
  put_tool(twin, Vec3(0, 0, 0.1), Vec3(kUnset, 0, 0));
  Tick last;
  for (int i = 0; i < 50; ++i) last = twin.rig.clock->next();  // a trial would have ended
  EXPECT_EQ(twin.world->diverged_at(), 100);
  EXPECT_FALSE(twin.world->divergence().empty());
  EXPECT_EQ(last.index, 149);
  EXPECT_NEAR(twin.world->physics().data()->time, 0.149, 1e-9);  // never reset to zero
}

TEST(World, WithoutAUserThereIsNoToolAndNothingCanTouch) {
  models::Setup setup = models::load(scene_file("tennis_ball"), "sim");
  setup.scene.user.reset();
  Twin twin(1, setup);
  const mjModel* model = twin.world->physics().model();
  EXPECT_EQ(model->nv, 6);  // the machine alone
  EXPECT_EQ(mj_name2id(model, mjOBJ_BODY, "tool"), -1);
  EXPECT_NE(model->opt.disableflags & mjDSBL_CONTACT, 0);
  EXPECT_NE(model->opt.disableflags & mjDSBL_CONSTRAINT, 0);
  twin.run(100);
  EXPECT_EQ(twin.world->physics().data()->ncon, 0);
  EXPECT_TRUE(twin.world->user_done());
}

// ---- machine commanded by hand, tool put where the test wants it
// --------------------------------------------------------

void command(Twin& twin, const Vec3& p_W) {
  const Point<'R'> at = twin.world->X_WR().inverse() * Point<'W'>(p_W);
  twin.rig.manipulator->command(Pose<'R', 'H'>(Quat::Identity(), at));
}
constexpr double kTogether = 0.007;  // m, radii of tip and tool

// A person who wants to be where the tip is pressed: the scene's press point put there, so that the hand
// pushes from above.
Twin& pressed(Twin& twin, double at_z) {
  command(twin, Vec3(0, 0, at_z));
  for (int i = 0; i < 4000 && twin.world->truth().contact_force.norm() < 1.0; ++i) twin.rig.clock->next();
  return twin;
}

TEST(World, ATipThatSlidesUnderTheToolDragsItSideways) {
  Twin twin(quick());
  pressed(twin, 0.008);
  ASSERT_GT(twin.world->truth().contact_force.norm(), 0.9);
  const double before = twin.world->truth().tool_tip.xyz[0];
  for (int i = 0; i < 60; ++i) {
    command(twin, Vec3(0.001, 0, 0.008));
    twin.rig.clock->next();
  }
  EXPECT_GT(twin.world->truth().tool_tip.xyz[0] - before, 0.0002);
}

// Contact pushes and never pulls: while the tip falls away at 50 mm/s, the tool feels no tension.
TEST(World, NoTensionWhileTheTipRetreats) {
  Twin twin(quick());
  pressed(twin, 0.008);
  ASSERT_GT(twin.world->truth().contact_force.norm(), 0.9);
  double tension = 0.0;
  double fastest = 0.0;
  for (int i = 0; i < 600; ++i) {
    command(twin, Vec3(0, 0, 0.008 - 0.05e-3 * std::min(i, 400)));
    twin.rig.clock->next();
    tension =
        std::max(tension, twin.world->truth().contact_force.xyz[2]);  // upwards on the tip would be a pull
    fastest = std::max(fastest, -twin.world->truth().tip_velocity.xyz[2]);
  }
  EXPECT_LT(tension, 0.05);
  EXPECT_GT(fastest, 0.045);
}

TEST(World, AFastToolIsStoppedByTheTip) {
  std::vector<std::string> loose = quick();  // nobody holds it back
  for (const char* text : {"truth.hand.grip_stiffness_N_per_mm=1e-6", "truth.hand.grip_damping_Ns_per_m=0"})
    loose.emplace_back(text);
  Twin twin(loose);
  twin.rig.clock->next();
  put_tool(twin, Vec3(0, 0, 0.030), Vec3(0, 0, -1.0));
  double lowest = 1.0;
  bool touched = false;
  for (int i = 0; i < 200; ++i) {
    twin.rig.clock->next();
    lowest = std::min(lowest, twin.world->truth().tool_tip.xyz[2]);
    touched = touched || twin.world->truth().touching;
  }
  EXPECT_TRUE(touched);
  EXPECT_GT(lowest, kTogether - 0.002);  // of 7 mm between centres
}

}  // namespace
}  // namespace enc::test
