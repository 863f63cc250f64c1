// A session in the twin: the tool is changed, nothing of it is felt, and all of it can be saved.
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/conformance/bench_world.h"

namespace enc::test {
namespace {

// The change comes after the first press.
std::vector<std::string> early() { return {"user.session.change_share=[0,0]", "user.session.duration_s=30"}; }

// Until the tool in the hand is this one; false if it never is.
bool run_until_held(Twin& twin, std::int32_t tool) {
  for (int i = 0; i < 30000; ++i) {
    twin.tick();
    if (twin.world->truth().tool == tool) return true;
  }
  return false;
}

TEST(SessionWorld, TheOverlayShowsTheNewToolWithItsFirstPose) {
  Twin twin(early(), 1, "session");
  std::int32_t newest = -1;
  double force = 0.0;
  bool hidden = false;
  ASSERT_TRUE(run_until_held(twin, -1));
  for (int i = 0; i < 4000; ++i) {
    twin.tick();
    if (twin.in.tool.health == Health::ok) newest = twin.in.tool.value.tool;
    hidden = hidden || twin.out.view.tool == -1;
    if (newest == 1) {
      EXPECT_EQ(twin.out.view.tool, 1);
    }
    if (twin.world->truth().phase == sim::Phase::change) {
      force = std::max(force, twin.world->truth().contact_force.norm());
      EXPECT_EQ(twin.out.deflection, 0.0);
      EXPECT_NE(twin.out.mode, Mode::hold) << why_text(twin.out.why);
    }
  }
  EXPECT_EQ(newest, 1);
  EXPECT_TRUE(hidden);  // while none was in view
  EXPECT_LE(force, 0.2);
}

TEST(SessionWorld, TheToolLaidDownStaysWhereItIs) {
  Twin twin(early(), 2, "session");
  ASSERT_TRUE(run_until_held(twin, 1));
  const mjModel* model = twin.world->physics().model();
  const mjData* data = twin.world->physics().data();
  const int joint = model->body_jntadr[mj_name2id(model, mjOBJ_BODY, "tool")];
  const double* q = data->qpos + model->jnt_qposadr[joint];
  const Vec3 there(q[0], q[1], q[2]);
  EXPECT_LT((there - twin.setup.scene.user->session->tray).norm(), 2e-3);
  twin.run(2000);
  EXPECT_LT((Vec3(q[0], q[1], q[2]) - there).norm(), 1e-9);
  EXPECT_EQ(twin.world->truth().tool_radius, twin.setup.scene.tools[1].tip_radius);
}

TEST(SessionWorld, GoesOnFromTheMiddleOfAChangeToTheBit) {
  Twin twin(early(), 3, "session");
  ASSERT_TRUE(run_until_held(twin, -1));
  twin.run(300);
  const std::vector<std::byte> saved = twin.world->save();
  const Inputs in = twin.in;
  const State state = twin.state;
  const Outputs out = twin.out;
  const std::uint64_t first = hashed(twin, 4000);
  EXPECT_EQ(twin.world->truth().tool, 1);
  twin.world->restore(saved);
  twin.in = in;
  twin.state = state;
  twin.out = out;
  EXPECT_EQ(hashed(twin, 4000), first);
}

TEST(SessionWorld, IsTheSameForTheSameSeed) {
  Twin a({}, 5, "session"), b({}, 5, "session"), c({}, 6, "session");
  const std::uint64_t first = hashed(a, 5000);
  EXPECT_EQ(hashed(b, 5000), first);
  EXPECT_NE(hashed(c, 5000), first);
}

// The tracker takes the pressing tool for the other one: the tip must neither leap nor let go. The other's
// tip is 15 mm farther down the shaft, so it is thought to be deep inside.
TEST(SessionWorld, AToolMistakenWhilePressingIsNotFelt) {
  Twin twin({"user.session.depth_mm=[4,4]", "user.session.press_mm_s=[4,4]", "user.session.hold_s=[3,3]",
             "truth.hand.aborted=0"},
            4, "session");
  while (twin.world->truth().phase != sim::Phase::hold) twin.tick();
  twin.run(1000);  // the hand has settled
  ASSERT_EQ(twin.out.mode, Mode::contact);
  const double force = twin.world->truth().contact_force.norm();
  const double given = twin.out.deflection;
  EXPECT_GT(force, 3.0);
  bool switched = false;
  twin.disturb = [](Inputs& in) { in.tool.value.tool = 1; };
  for (int i = 0; i < 100; ++i) {
    twin.tick();
    switched = switched || twin.out.view.tool == 1;
    EXPECT_NEAR(twin.world->truth().contact_force.norm(), force, 0.2) << i;
    EXPECT_NEAR(twin.out.deflection, given, 0.1e-3) << i;
  }
  EXPECT_TRUE(switched);
  EXPECT_EQ(twin.out.contacts, 1);
}

}  // namespace
}  // namespace enc::test
