// The energy that a law gives out, worked by hand: observed, remaining and delivered energy. Also machines
// that do not follow.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "core/control/safety/following.h"
#include "core/control/safety/passivity/passivity.h"
#include "models/setup/scene_file.h"
#include "tests/support/scenes.h"
#include "tests/unit/trial/runs.h"
#include "trial/finger_loop.h"
#include "trial/trial.h"

namespace enc {
namespace {

using test::Loop;

// The law may give out g = 1 mm/N, so it moves a kilogram in sqrt(2e-3) s.
constexpr double kG = 1e-3;

Passivity with(double left, double moved = 0.0) {
  Passivity now;
  begin(now, {moved, 1.0, 1.0}, left);
  return now;
}
double given(double left, double moved, double wanted, double count = 0.0) {
  return passive(with(left, moved), wanted, kG, count);
}

TEST(Passivity, AHeldPushDoesItsWork) {
  Passivity now;
  begin(now, {0.0, 0.0, 0.0}, 0.0);
  hold(now, 2.0, 2.0);
  observe(now, {-1e-3, 1e-3, 8.0}, 0.0);  // pressed in by 1 mm: 2 mJ in; the spring holds 4 mJ
  EXPECT_DOUBLE_EQ(now.given, -2e-3);
  EXPECT_DOUBLE_EQ(now.stored, 4e-3);
  EXPECT_DOUBLE_EQ(now.left, 2e-3);
  hold(now, 3.0, 5.0);
  observe(now, {0.5e-3, 0.5e-3, 4.0}, 0.0);  // back by half: 1.5 mJ out, 1 mJ less than requested
  EXPECT_DOUBLE_EQ(now.given, -0.5e-3);
  EXPECT_DOUBLE_EQ(now.left, 0.5e-3);
  EXPECT_DOUBLE_EQ(now.stored, 1e-3);
  EXPECT_DOUBLE_EQ(now.dissipated, 1e-3);
  EXPECT_DOUBLE_EQ(now.most, 2.0);
}

// A long press puts much energy into the law's damper. That energy does not come back, and must not hide a
// deficit.
TEST(Passivity, WhatADamperTookIsNotLeft) {
  Passivity now;
  begin(now, {0.0, 0.0, 0.0}, 0.0);
  double depth = 0.0;
  for (int i = 0; i < 1000; ++i) {
    hold(now, 4.0, 4.0);
    const double before = depth;
    depth = i % 2 == 0 ? 2e-3 : 1e-3;
    if (i % 2 == 1) now.pushed = 1.0;  // pushed in against 4 N, out with 1 N
    observe(now, {before - depth, depth, 1000.0 * depth}, 0.0);
  }
  EXPECT_NEAR(now.given, -1.5, 5e-3) << "J";
  EXPECT_NEAR(now.left, 0.5e-3, 1e-12) << "half of 1000 N/m, 1 mm deep";
}

TEST(Passivity, NoMoreIsGivenThanIsLeftAfterThePeriod) {
  EXPECT_DOUBLE_EQ(given(2e-3, 1e-3, 9.0), 1.0) << "1 N over 1 mm and the 1 mm that it makes itself";
  EXPECT_DOUBLE_EQ(given(4e-3, 0.0, 9.0), 2.0) << "at rest: nothing is divided by a speed";
  EXPECT_DOUBLE_EQ(given(0.0, 0.0, 9.0), 0.0);
  EXPECT_DOUBLE_EQ(given(0.0, -2e-3, 9.0), 2.0) << "inwards it stops, and gives out nothing";
  EXPECT_DOUBLE_EQ(given(2e-3, 1e-3, 0.7), 0.7) << "what is within it stays";
  EXPECT_DOUBLE_EQ(given(2e-3, 1e-3, -0.7), -0.7) << "and what takes in";
  EXPECT_DOUBLE_EQ(given(2e-3, -1e-3, -9.0), -1.0) << "a pull likewise";
}

// The controller reduces a push but never reverses it: a reversed push would pull the person towards the
// object.
TEST(Passivity, WhatIsOwedIsNotGivenAgain) {
  EXPECT_DOUBLE_EQ(given(-0.75e-3, 2e-3, 9.0), 0.0);
  EXPECT_DOUBLE_EQ(given(-1.0, 2e-3, 9.0), 0.0);
  EXPECT_DOUBLE_EQ(given(-1.0, 2e-3, -1.0), -1.0) << "what takes in is free";
  EXPECT_DOUBLE_EQ(given(-0.75e-3, -2e-3, 0.0), 0.0) << "nothing that the law does not ask for";
  EXPECT_DOUBLE_EQ(given(-1.0, -2e-3, 9.0), 2.0) << "inwards it stops, and is paid";
  std::mt19937_64 draw(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 10000; ++i) {
    const double asked = 5.0 * normal(draw), now = given(1e-3 * normal(draw), 1e-3 * normal(draw), asked);
    EXPECT_GE(now * asked, 0.0);
    EXPECT_LE(std::abs(now), std::abs(asked));
  }
}

TEST(Passivity, NoMoreIsKeptThanTheSpringHolds) {
  Passivity now;
  begin(now, {0.0, 1e-3, 2.0}, 5e-3);
  EXPECT_DOUBLE_EQ(now.left, 1e-3);
  EXPECT_DOUBLE_EQ(now.given, -1e-3) << "it was put in before";
  begin(now, {0.0, 1e-3, 2.0}, -5e-3);
  EXPECT_DOUBLE_EQ(now.left, -5e-3) << "what is owed stays";
}

// An encoder with a count of 1 mm: the true position may be half a count deeper, and a reading that changes
// by one count is no motion.
TEST(Passivity, ACountIsNoMotion) {
  constexpr double kCount = 1e-3;
  EXPECT_DOUBLE_EQ(given(0.0, 0.0, 9.0, kCount), 0.5) << "half a count farther in, for all that is known";
  EXPECT_DOUBLE_EQ(given(-0.02e-3, 0.0, 9.0, kCount), 0.5) << "and where little is owed for that";
  EXPECT_DOUBLE_EQ(given(-0.04e-3, 0.0, 9.0, kCount), 0.0) << "but no more";
  Passivity now = with(1e-3);
  for (int i = 0; i < 100; ++i) {
    const double push = i % 2 == 0 ? 2.0 : 1.0;  // 1 mJ each time, if it were a motion
    hold(now, push, push);
    observe(now, {i % 2 == 0 ? kCount : -kCount, 1.0, 1.0}, kCount);
  }
  EXPECT_DOUBLE_EQ(now.given, -1e-3);
  hold(now, 1.0, 1.0);
  observe(now, {kCount, 1.0, 1.0}, kCount);
  observe(now, {kCount, 1.0, 1.0}, kCount);
  EXPECT_DOUBLE_EQ(now.given, 1e-3) << "two counts are";
}

TEST(Passivity, AnotherSpringGivesNothing) {
  Passivity now;
  begin(now, {0.0, 2e-3, 1.0}, 1e-3);
  renew(now, {0.0, 10e-3, 10.0});
  observe(now, {0.0, 10e-3, 10.0}, 0.0);
  EXPECT_DOUBLE_EQ(now.left, 1e-3) << "though it holds 50 mJ";
  renew(now, {0.0, 1e-3, 1.0});
  observe(now, {0.0, 1e-3, 1.0}, 0.0);
  EXPECT_DOUBLE_EQ(now.left, 0.5e-3);
}

TEST(Passivity, OneThatIsOffIsNotRemembered) {
  int leaves = 0;
  const auto count = [&](std::string_view, const auto&) { ++leaves; };
  Passivity now;
  fields(count, now);
  EXPECT_EQ(leaves, 0);
  now.on = true;
  fields(count, now);
  EXPECT_EQ(leaves, 12);
}

// A mass of 0.1 kg at 1 kHz under any law. The controller cannot foresee other pushes: only their work may
// take the energy beyond the start.
TEST(Passivity, AnyLawOnAnyWalkStaysWithinWhatThereWas) {
  constexpr double kPerNewton = 5e-6;
  std::mt19937_64 draw(20);
  std::normal_distribution<double> normal;
  for (int walk = 0; walk < 300; ++walk) {
    const double pushes = walk % 3 == 0 ? 0.0 : std::exp(normal(draw) - 10.0);  // m, the unforeseen part
    const double stiffness = std::exp(8.0 + 3.0 * normal(draw)), wild = walk % 2 == 0 ? 0.0 : 8.0;
    double depth = 1e-3, u = 1e-4 * normal(draw), out = 0.0, excused = 0.0, most = 0.0;
    Passivity now;
    begin(now, {u, depth, stiffness * depth}, std::abs(normal(draw)) * 1e-3);
    const double held = now.left;
    for (int i = 0; i < 2000; ++i) {
      const double asked = std::clamp(stiffness * depth + wild * normal(draw), -8.5, 8.5);
      const double push = passive(now, asked, kPerNewton, 0.0);
      hold(now, push, asked);
      const double missed = pushes * normal(draw), way = u + kPerNewton * push + missed;
      out += push * way;
      excused += std::max(0.0, push * missed);
      depth -= way;
      observe(now, {way, depth, stiffness * depth}, 0.0);
      u = way + kPerNewton * push;
      most = std::max(most, out - held - excused);
    }
    EXPECT_NEAR(now.given, out - held, 1e-9 * (1.0 + std::abs(out))) << "observed";
    EXPECT_LE(most, 1e-12) << walk;
  }
}

// A machine that takes positions.
TEST(Passivity, TheWayOutTakesWhatIsLeft) {
  constexpr double kHand = 700.0;
  const auto out = [](double left, double push, double stiffness) {
    return way_left(with(left), kForgiven, push, stiffness);
  };
  EXPECT_NEAR(out(2e-3 - kForgiven, 4.0, 0.0), 0.5e-3, 1e-15) << "an even push: 4 N over 0.5 mm";
  for (const double left : {-1e-3, -kForgiven, 0.0, 1e-4, 5e-2})
    for (const double push : {-1.0, 0.0, 0.1, 5.0}) {
      const double s = out(left, push, kHand), p = std::max(0.0, push);
      const double paid = std::max(0.0, std::min(left, 0.5) + kForgiven);
      EXPECT_NEAR(p * s + 0.5 * kHand * s * s, paid, 1e-15) << left << " J, " << push << " N";
      EXPECT_GE(s, 0.0) << "never in";
    }
  EXPECT_EQ(out(-1.0, 3.0, kHand), 0.0) << "what is owed is paid first";
  EXPECT_LT(out(1e-3, 3.0, kHand), out(1e-3, 2.9, kHand));
}

// The check detects a machine that does not follow its commands, and accepts one that is only slower than the
// rig states.

// A servo of second order, x'' = w^2 (c - x) - 2 z w x', `delay` ticks late.
struct Servo {
  double hz, damping = 0.8;
  int delay = 4;
  double x = 0.0, v = 0.0;
  std::vector<double> line{};
  double tick(double command) {
    line.push_back(command);
    const double c = line.size() > static_cast<std::size_t>(delay)
                         ? line[line.size() - 1 - static_cast<std::size_t>(delay)]
                         : 0.0;
    const double w = 2.0 * M_PI * hz;
    for (int i = 0; i < 10; ++i) {
      v += 1e-4 * (w * w * (c - x) - 2.0 * damping * w * v);
      x += 1e-4 * v;
    }
    return x;
  }
};

// Time until the check finds that a machine does not follow an even motion of 50 mm/s over 10 mm, s; -1: it
// follows.
double found_out(Servo servo) {
  const ServoModel believed{2.0 * M_PI * 15.0, 0.8, 0.004, 1e-3};
  FollowingState state;
  double c = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double v = i < 200 ? 0.05 : 0.0;
    c += 1e-3 * v;
    const double x = servo.hz > 0.0 ? servo.tick(c) : 0.0;
    if (!follows(believed, Point<'R'>(c, 0, 0), Vec<'R'>(v, 0, 0), Point<'R'>(x, 0, 0), state))
      return 1e-3 * i;
  }
  return -1.0;
}

TEST(Following, AMachineAsTheRigSaysFollows) {
  for (const double hz : {10.0, 15.0, 30.0, 200.0})
    for (const int delay : {0, 4, 10}) EXPECT_EQ(found_out({hz, 0.8, delay}), -1.0) << hz << " " << delay;
}

TEST(Following, AMachineThatStandsOrCrawlsIsFoundOut) {
  for (const double hz : {0.0, 1e-6, 0.5}) {
    const double after = found_out({hz});
    EXPECT_GT(after, 0.0) << hz;
    EXPECT_LT(after, 0.3) << hz;
  }
}

TEST(Following, AMachineAtAnotherScaleIsFoundOut) {
  const ServoModel believed{2.0 * M_PI * 15.0, 0.8, 0.004, 1e-3};
  FollowingState state;
  bool follows_still = true;
  for (int i = 0; i < 1000; ++i) {
    const double c = 1e-5 * std::min(i, 500);  // 5 mm at 10 mm/s
    follows_still = follows(believed, Point<'R'>(c, 0, 0), Vec<'R'>(i < 500 ? 0.01 : 0.0, 0, 0),
                            Point<'R'>(0.5 * c, 0, 0), state);
    if (!follows_still) break;
  }
  EXPECT_FALSE(follows_still);
}

// A machine that stays at its first position, whatever the command.
std::function<void(Inputs&)> standing(bool withheld) {
  return [withheld, stands = Measurement<TipSample>{}](Inputs& in) mutable {
    if (stands.health == Health::absent) stands = in.tip;
    stands.t = in.tip.t;
    in.tip = stands;
    in.withheld = withheld;
  };
}

TEST(Following, AMachineThatStandsIsHeldUntilTheToolHasGone) {
  Loop loop(prepare(test::plane_scene(), test::exact_rig()));
  loop.tool_tip = Point<'W'>(0.02, 0, 0.03);
  loop.spoil = standing(false);
  double farthest = 0.0;
  for (int i = 0; i < 1000; ++i) {
    loop.tick();
    farthest = std::max(farthest, loop.tip().xyz[0]);
  }
  EXPECT_EQ(loop.out.mode, Mode::hold);
  EXPECT_NE(loop.out.why & kNotFollowing, 0U) << why_text(loop.out.why);
  EXPECT_LT(farthest, 0.008);
  EXPECT_LT(loop.tip().e().norm(),
            1e-4);  // the command has returned to the machine, so it does not leap when released
  EXPECT_LE(loop.worst_speed, 1.0 + 1e-9);
  EXPECT_LE(loop.worst_acceleration, 1.0 + 1e-9);
  loop.spoil = {};
  loop.tick(1000);
  EXPECT_EQ(loop.out.mode, Mode::hold);
  loop.tool_tip = Point<'W'>(0.02, 0, 0.15);
  loop.tick(10);
  EXPECT_EQ(loop.out.mode, Mode::away) << why_text(loop.out.why);
  loop.tool_tip = Point<'W'>(0.02, 0, 0.03);
  loop.tick(1000);
  EXPECT_EQ(loop.out.mode, Mode::follow);
  EXPECT_NEAR(loop.tip().xyz[0], 0.02, 1e-6);
}

// No assumption of the rig switches the check off.
TEST(Following, ARigThatBelievesInASlowMachineFindsOutAllTheSame) {
  for (const double hz : {1e-6, 0.01, 1.0}) {
    const ServoModel believed{2.0 * M_PI * hz, 0.8, 0.004, 1e-3};
    FollowingState state;
    bool found = false;
    for (int i = 0; i < 3000 && !found; ++i) {
      const double v = i < 1000 ? 0.05 : 0.0;
      found = !follows(believed, Point<'R'>(5e-5 * std::min(i, 1000), 0, 0), Vec<'R'>(v, 0, 0),
                       Point<'R'>(0, 0, 0), state);
    }
    EXPECT_TRUE(found) << hz;
  }
}

// A machine cannot follow a command that is withheld.
TEST(Following, ADryRunIsNotHeld) {
  Loop loop(prepare(test::plane_scene(), test::exact_rig()));
  loop.tool_tip = Point<'W'>(0.02, 0, 0.03);
  loop.spoil = standing(true);
  loop.tick(1000);
  EXPECT_EQ(loop.out.mode, Mode::follow) << why_text(loop.out.why);
}

trial::TrialResult run(const std::string& scene, const std::vector<std::string>& set, double seconds) {
  trial::TrialOptions options{.seconds = seconds};
  return trial::Trial(test::shipped(scene, set), options).run();
}

TEST(Following, ATwinWithADeadServoEndsInHold) {
  const trial::TrialResult dead = run("tennis_ball", {"truth.hexapod.servo_hz=1e-6"}, 10.0);
  EXPECT_EQ(dead.last_mode, Mode::hold);
  EXPECT_NE(dead.last_why & kNotFollowing, 0U) << why_text(dead.last_why);
  EXPECT_TRUE(run("tennis_ball", {}, 10.0).holds.empty());
}

// An arm that stays at home, whatever the command; the finger is at another place of the wall.
TEST(Following, AnArmThatIsStuckIsFoundOutUnderATouchToo) {
  const std::vector<std::string> exact{"rig.tracker.prediction=\"hold\"", "rig.tracker.usual_age_ms=2"};
  trial::FingerLoop loop(trial::prepare_setup(test::shipped("wall", exact)));
  loop.in.withheld = false;
  for (int i = 0; i < 200; ++i) loop.tick(Point<'W'>(0.060, 0.0, 0.058));
  for (int i = 0; i < 1000; ++i) loop.tick(Point<'W'>(0.060, 0.0, 0.005));  // 3 mm deep, 60 mm from the tip
  EXPECT_EQ(loop.out.mode, Mode::hold);
  EXPECT_NE(loop.out.why & kNotFollowing, 0U) << why_text(loop.out.why);
}

TEST(Following, AnArmThatIsStuckIsHeldUntilTheFingerHasGone) {
  const std::vector<std::string> exact{"rig.tracker.prediction=\"hold\"", "rig.tracker.usual_age_ms=2"};
  trial::FingerLoop loop(trial::prepare_setup(test::shipped("wall", exact)));
  loop.in.withheld = false;
  const auto at = [&](double gap, int ticks) {
    for (int i = 0; i < ticks; ++i) loop.tick(Point<'W'>(0.060, 0.0, 0.008 + gap));
    return loop.out;
  };
  EXPECT_EQ(at(0.050, 200).mode, Mode::follow) << why_text(loop.out.why);
  EXPECT_EQ(at(0.050, 600).mode, Mode::hold);
  EXPECT_NE(loop.out.why & kNotFollowing, 0U) << why_text(loop.out.why);
  EXPECT_EQ(at(0.050, 2000).mode, Mode::hold);        // and does not try again
  EXPECT_LT(loop.out.force_unfiltered.norm(), 1e-9);  // gravity alone
  EXPECT_EQ(at(0.150, 10).mode, Mode::away);
  EXPECT_EQ(at(0.050, 200).mode, Mode::follow);  // a fresh reason
}

}  // namespace
}  // namespace enc
