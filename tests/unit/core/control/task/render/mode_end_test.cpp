// Each mode ends when its cause has (mode.h).
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace enc {
namespace {

using test::kToolRadius;
using test::kTop;
using test::Loop;

Point<'W'> at_gap(double gap) { return {0, 0, kTop + kToolRadius + gap}; }

// A tool that was clear, and now presses with 5 N at this gap.
Loop pressed(double gap, const SceneSpec& scene = test::plane_scene()) {
  Loop loop(prepare(scene, test::exact_rig()));
  loop.tool_tip = at_gap(0.02);
  loop.tick(1500);
  loop.tool_tip = at_gap(gap);
  loop.force = Vec<'W'>(0, 0, -5.0);
  loop.tick(1000);
  return loop;
}

// A sensor whose zero drifts by 0.02 N during a press, on an object so soft that this is more than the leave
// gap; behind the damper that such an object needs.
TEST(ModeEnds, AContactBehindADamperWhoseZeroHasDrifted) {
  RigSpec rig = test::exact_rig();
  rig.admittance.damping = Damping::observed;
  rig.force.threshold = 0.0;
  rig.contact.softest = 0.0;
  Loop loop(prepare(test::plane_scene(test::spring(15.0)), rig));
  loop.tool_tip = at_gap(0.02);
  loop.tick(1500);
  loop.tool_tip = at_gap(-0.004);
  loop.force = Vec<'W'>(0, 0, -0.3);
  loop.tick(3000);
  ASSERT_EQ(loop.out.mode, Mode::contact);
  loop.force_zero = Vec<'F'>(0, 0, -0.02);
  loop.force = Vec<'W'>::zero();
  loop.tool_tip = at_gap(0.050);
  loop.tick(3000);
  EXPECT_EQ(loop.out.mode, Mode::follow);
  // And without a tool that is seen to have gone: after 5 s.
  Loop blind(prepare(
      [] {
        SceneSpec spec = test::plane_scene(test::spring(15.0));
        spec.tracker.reset();
        spec.tools.clear();
        return spec;
      }(),
      rig));
  blind.tick(1500);
  blind.force = Vec<'W'>(0, 0, -0.3);
  blind.tick(3000);
  ASSERT_EQ(blind.out.mode, Mode::contact);
  blind.force_zero = Vec<'F'>(0, 0, -0.02);
  blind.force = Vec<'W'>::zero();
  blind.tick(7500);
  EXPECT_NE(blind.out.mode, Mode::contact);
}

// A touch that is never felt: the tool comes to the surface and goes back to 5 mm.
TEST(ModeEnds, AContactInWhichNoForceWasFelt) {
  Loop loop(prepare(test::plane_scene(), test::exact_rig()));
  loop.tool_tip = at_gap(0.02);
  loop.tick(1500);
  loop.tool_tip = at_gap(-0.0001);
  loop.tick(2);
  ASSERT_EQ(loop.out.mode, Mode::contact);
  loop.tool_tip = at_gap(0.005);
  loop.tick(400);
  EXPECT_EQ(loop.out.mode, Mode::contact);  // it may be that the tool is only coming
  loop.tick(300);
  EXPECT_EQ(loop.out.mode, Mode::follow);
}

// A zero that drifts during a press, and a tool that then waits 8.5 mm away: what is felt of it is no touch.
TEST(ModeEnds, AContactOfAToolThatIsSeenToBeClear) {
  for (const double drift : {0.06, 0.1, 0.2, 1.0}) {
    Loop loop = pressed(-0.002);
    ASSERT_EQ(loop.out.mode, Mode::contact);
    loop.force_zero = Vec<'F'>(0, 0, -drift);
    loop.force = Vec<'W'>::zero();
    loop.tool_tip = at_gap(0.0085);
    loop.tick(1500);
    EXPECT_EQ(loop.out.mode, Mode::follow) << drift;
    EXPECT_NEAR(recall<Commanded>(loop.state).force_zero.xyz[2], -drift, 0.02)
        << drift;  // and it is learnt anew
    const std::int32_t contacts = loop.out.contacts;
    loop.tick(5000);
    EXPECT_EQ(loop.out.contacts, contacts) << drift;
  }
}

SceneSpec two_tools() {
  SceneSpec spec = test::plane_scene();
  ToolSpec other = spec.tools.front();
  other.name = "other";
  for (Vec3& marker : other.markers) marker *= 1.3;
  spec.tools.push_back(other);
  return spec;
}

// A contact whose own tool is hidden from here on, while another one is seen at this gap.
Loop hidden(double gap) {
  Loop loop = pressed(-0.002, two_tools());
  EXPECT_EQ(loop.out.mode, Mode::contact);
  loop.tool = 1;
  loop.tool_tip = at_gap(gap);
  return loop;
}

// The tool vanishes as it lets go, another one is seen 150 mm away, and the zero is off: no cause is left.
TEST(ModeEnds, AContactWhoseToolIsOutOfViewWhileAnotherIsSeenClear) {
  for (const double drift : {0.06, 0.12, 0.5, 2.0}) {
    SCOPED_TRACE(drift);
    Loop loop = hidden(0.150);
    loop.force_zero = Vec<'F'>(0, 0, -drift);
    loop.force = Vec<'W'>::zero();
    loop.tick(drift < 0.3 ? 8000 : 63'000);
    EXPECT_EQ(loop.out.mode, Mode::away) << why_text(loop.out.why);
    const std::int32_t contacts = loop.out.contacts;
    loop.tick(20'000);
    EXPECT_EQ(loop.out.mode, Mode::away);
    EXPECT_EQ(loop.out.contacts, contacts);
  }
}

// The other tool lies on the object's edge, where it touches nothing.
TEST(ModeEnds, AContactWhoseToolIsOutOfViewWhileAnotherIsNear) {
  Loop loop = hidden(0.0029);
  loop.force_zero = Vec<'F'>(0, 0, -0.12);
  loop.force = Vec<'W'>::zero();
  bool over = false;
  for (int i = 0; i < 65'000 && !over; ++i) {
    loop.tick();
    over = loop.out.mode != Mode::contact;
  }
  EXPECT_TRUE(over);
}

// Poses that are late for 60 ms, every 4 s.
TEST(ModeEnds, AContactWhoseToolIsOutOfViewWhilePosesAreLate) {
  Loop loop = hidden(0.150);
  loop.force_zero = Vec<'F'>(0, 0, -0.12);
  loop.force = Vec<'W'>::zero();
  int ticks = 0;
  auto last = Inputs{}.tool;
  loop.spoil = [&](Inputs& in) {
    if (ticks++ % 4000 < 60)
      in.tool = last;
    else
      last = in.tool;
  };
  loop.tick(9000);
  EXPECT_EQ(loop.out.mode, Mode::away) << why_text(loop.out.why);
}

// A hand that presses varies its force: its contact stays, though its own tool is hidden and another lies in
// view.
TEST(ModeEnds, NotAContactWhoseForceVariesWhileItsToolIsHidden) {
  for (const double force : {0.5, 1.0, 3.0}) {
    Loop loop = hidden(0.150);
    for (int i = 0; i < 100'000; ++i) {
      loop.force = Vec<'W'>(0, 0, -force * (1.0 - 0.04 * std::sin(2e-3 * i)));  // 0.3 Hz
      loop.tick();
      ASSERT_EQ(loop.out.mode, Mode::contact) << force << " N, " << i;
    }
    EXPECT_EQ(loop.out.contacts, 1);
  }
}

// A hand so still that its contact ends: its force is not learnt as the zero while its tool is hidden.
TEST(ModeEnds, WithoutLearningTheForceOfAHiddenHand) {
  for (const double force : {0.2, 2.0}) {
    Loop loop = hidden(0.150);
    loop.force = Vec<'W'>(0, 0, -force);
    loop.tick(63'000);
    EXPECT_EQ(loop.out.mode, Mode::away);
    loop.tick(20'000);
    EXPECT_NEAR(recall<Commanded>(loop.state).force_zero.norm(), 0.0, 1e-3) << force;
    loop.tool = 0;
    loop.tool_tip = at_gap(0.150);  // and it is again when that tool is seen clear
    loop.force = Vec<'W'>::zero();
    loop.force_zero = Vec<'F'>(0, 0, -0.03);
    loop.tick(20'000);
    EXPECT_NEAR(recall<Commanded>(loop.state).force_zero.xyz[2], -0.03, 0.005) << force;
  }
}

// Only the tool that the gripper holds is in view when the tip is back: there is nothing to follow.
TEST(ModeEnds, RestoringWithNoToolInViewEndsInAway) {
  SceneSpec spec = two_tools();
  spec.gripper.emplace().tool = "other";
  Loop loop(prepare(spec, test::exact_rig()));
  loop.spoil = [&loop](Inputs& in) {
    in.grip = {{GripPhase::closed, 0.006, 100.0, true}, loop.now(), Health::ok};
  };
  loop.tool_tip = at_gap(0.02);
  loop.tick(1500);
  loop.tool_tip = at_gap(-0.002);
  loop.force = Vec<'W'>(0, 0, -5.0);
  loop.tick(1000);
  ASSERT_EQ(loop.out.mode, Mode::contact) << why_text(loop.out.why);
  loop.force = Vec<'W'>::zero();
  loop.tool = 1;
  for (int i = 0; i < 8000; ++i) {
    loop.tick();
    ASSERT_NE(loop.out.mode, Mode::hold) << i << ": " << why_text(loop.out.why);
  }
  EXPECT_EQ(loop.out.mode, Mode::away);
}

// A tip that never gets to where it was, and never stands still: noise of a machine, or a surface that is in
// the way.
TEST(ModeEnds, RestoringATipThatNeverStands) {
  Loop loop = pressed(-0.001);
  ASSERT_EQ(loop.out.mode, Mode::contact);
  loop.force = Vec<'W'>::zero();
  loop.tool_tip = at_gap(0.02);
  loop.spoil = [&](Inputs& in) {
    in.tip.value.velocity = Vec<'R'>(0, 0, 1e-3);
    in.tip.value.X_RH.xyz[2] -= 10e-6;
  };
  loop.tick(1000);
  EXPECT_EQ(loop.out.mode, Mode::restore);
  loop.tick(1500);
  EXPECT_EQ(loop.out.mode, Mode::follow);
}

}  // namespace
}  // namespace enc
