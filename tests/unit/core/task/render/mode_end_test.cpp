// Each mode ends when its cause has (mode.h).
#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace enc {
namespace {

using test::kToolRadius;
using test::kTop;
using test::Loop;

Point<'W'> at_gap(double gap) { return {0, 0, kTop + kToolRadius + gap}; }

// A tool that was clear, and now presses with 5 N at this gap.
Loop pressed(double gap) {
  Loop loop(prepare(test::plane_scene(), test::exact_rig()));
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
