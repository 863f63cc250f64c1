// The tracker loses the tool and finds it again: what is believed is at once what is seen, and nothing of the
// time between gets into the zero of the force. What is smoothed is the command.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/built.h"
#include "tests/support/scenes.h"
#include "trial/trial.h"

namespace enc {
namespace {

using test::kToolRadius;
using test::kTop;
using test::Loop;

Point<'W'> at_gap(double gap, double x = 0.0) { return {x, 0, kTop + kToolRadius + gap}; }

// A tool that waits at a gap, with the tip under it and the zero learnt.
Loop waiting(double gap, const RigSpec& rig = {}) {
  Loop loop(prepare(test::plane_scene(), rig));
  loop.tool_tip = at_gap(gap);
  loop.tick(1500);
  return loop;
}

TEST(DropOut, AToolThatPressesAfterItWasUnseenIsInContactAtOnce) {
  for (const double from : {0.040, 0.080}) {
    Loop loop = waiting(from);
    ASSERT_EQ(loop.out.mode, Mode::follow) << why_text(loop.out.why);
    loop.tool_seen = false;
    loop.tick(300);
    loop.tool_tip = at_gap(-0.0005);
    loop.force = Vec<'W'>(0, 0, -5.0);
    loop.tick(100);
    EXPECT_EQ(loop.out.mode, Mode::hold);
    loop.tool_seen = true;
    loop.tick(2);
    EXPECT_EQ(loop.out.mode, Mode::contact) << from;
    EXPECT_NEAR(loop.out.gap, -0.0005, 1e-4) << from;
    EXPECT_NEAR(recall<Commanded>(loop.state).force_zero.norm(), 0.0, 1e-6) << from;
    loop.tick(1000);
    EXPECT_NEAR(loop.out.deflection, (5.0 - 0.05) / 2000.0, 1e-5) << from;  // 2 N/mm, threshold 0.05 N
  }
}

// The belief leaps, the machine does not: it goes there within its limits.
TEST(DropOut, TheCommandCatchesUpWithoutALeap) {
  Loop loop = waiting(0.040);
  const Point<'W'> before = loop.tip();
  loop.tool_seen = false;
  loop.tick(300);
  loop.tool_tip = at_gap(0.040, 0.012);
  loop.tool_seen = true;
  loop.tick(2);
  EXPECT_NEAR(loop.out.view.tip.xyz[0], 0.012, 1e-4);  // where the tool is believed
  EXPECT_LT((loop.tip() - before).norm(), 1e-5);
  loop.tick(1000);
  EXPECT_NEAR(loop.tip().xyz[0], 0.012, 1e-6);
  EXPECT_LE(loop.worst_speed, 1.0 + 1e-9);
  EXPECT_LE(loop.worst_acceleration, 1.0 + 1e-9);
}

// A black-out of 0.3 s while the hand comes down at 200 mm/s: the press that follows is felt.
TEST(DropOut, APressAfterABlackOutIsFelt) {
  const auto peak = [](const char* at) {
    const models::Setup setup = models::load(
        tests::source_dir() + "/models/scenes/tennis_ball.toml", {},
        {"user.approach_mm_s=[200]", "user.approach_from_mm=100", "user.press_s=1", "user.release_s=1",
         std::string("truth.tracker.blackout_at_s=") + at, "truth.tracker.blackout_for_s=0.3"});
    double most = 0.0;
    trial::TrialOptions options;
    options.seconds = 4.0;
    options.watch = [&](const trial::Glance& glance) {
      most = std::max(most, std::abs(glance.out.force.xyz[2]));
    };
    trial::Trial(setup, options).run();
    return most;
  };
  const double undisturbed = peak("100");
  EXPECT_GT(undisturbed, 8.0);
  EXPECT_GT(peak("0.75"), 0.8 * undisturbed);
}

// ---- the zero of the force ------------------------------------------------------------------------------

TEST(Retare, NotWhileTheToolIsUnseen) {
  for (const Tare tare : {Tare::free, Tare::window}) {
    RigSpec rig;
    rig.force.tare = tare;
    Loop loop = waiting(0.150, rig);  // away
    ASSERT_EQ(loop.out.mode, Mode::away);
    loop.tool_seen = false;
    loop.tick(200);  // it is no longer known
    loop.force = Vec<'W'>(0, 0, -5.0);
    loop.tick(5000);
    EXPECT_NEAR(recall<Commanded>(loop.state).force_zero.norm(), 0.0, 1e-6);
    loop.tool_seen = true;
    loop.tool_tip = at_gap(-0.0005);
    loop.tick(1000);
    EXPECT_NEAR(loop.out.deflection, (5.0 - 0.05) / 2000.0, 1e-5);
  }
}

TEST(Retare, NotWhenThePoseIsOldAndNotInAHold) {
  Loop loop = waiting(0.040);
  loop.tool_seen = false;
  loop.tick(46);  // usual_age
  loop.force_zero = Vec<'F'>(0, 0, -1.0);
  loop.tick(500);  // predicted, then lost
  EXPECT_NEAR(recall<Commanded>(loop.state).force_zero.norm(), 0.0, 1e-6);
  loop.tool_seen = true;
  loop.spoil = [](Inputs& in) {
    in.missed = 100;
  };  // a clock that is late each time: a hold with all else well
  loop.tick(500);
  EXPECT_EQ(loop.out.mode, Mode::hold);
  EXPECT_NEAR(recall<Commanded>(loop.state).force_zero.norm(), 0.0, 1e-6);
  loop.spoil = {};
  loop.tick(500);
  EXPECT_LT(recall<Commanded>(loop.state).force_zero.xyz[2], -0.1);  // and then it is learnt
}

// Before the first zero is known nothing is learnt of a tool that is not seen either.
TEST(Retare, TheFirstZeroNeedsAToolThatIsSeenToBeClear) {
  Loop loop(prepare(test::plane_scene(), RigSpec{}));
  loop.tool_seen = false;
  loop.force = Vec<'W'>(0, 0, -5.0);
  loop.tick(1000);
  EXPECT_NE(loop.out.why & kTaring, 0U);
  loop.force = Vec<'W'>::zero();
  loop.tool_seen = true;
  loop.tool_tip = at_gap(0.010);
  loop.tick(300);
  EXPECT_EQ(loop.out.why & kTaring, 0U);
  EXPECT_NEAR(recall<Commanded>(loop.state).force_zero.norm(), 0.0, 1e-6);
}

}  // namespace
}  // namespace enc
