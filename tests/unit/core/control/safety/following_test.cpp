// A machine that does not do what it is told is found out, and one that is only slower than the rig says is
// not.
#include "core/control/safety/following.h"

#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "tests/support/scenes.h"
#include "trial/finger_loop.h"
#include "trial/trial.h"

namespace enc {
namespace {

using test::Loop;

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

// s after which a machine is found not to follow an even motion of 50 mm/s over 10 mm; -1: it follows.
double found_out(Servo servo) {
  const ServoModel believed{2.0 * M_PI * 15.0, 0.8, 0.004, 1e-3};
  Following state;
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
  Following state;
  bool follows_still = true;
  for (int i = 0; i < 1000; ++i) {
    const double c = 1e-5 * std::min(i, 500);  // 5 mm at 10 mm/s
    follows_still = follows(believed, Point<'R'>(c, 0, 0), Vec<'R'>(i < 500 ? 0.01 : 0.0, 0, 0),
                            Point<'R'>(0.5 * c, 0, 0), state);
    if (!follows_still) break;
  }
  EXPECT_FALSE(follows_still);
}

// A machine that stays where it is first heard of, whatever it is told.
std::function<void(Inputs&)> standing(bool withheld) {
  return [withheld, stands = Stamped<TipSample>{}](Inputs& in) mutable {
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
            1e-4);  // the command has come back to it: nothing leaps when it is free again
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

// No belief of the rig switches it off.
TEST(Following, ARigThatBelievesInASlowMachineFindsOutAllTheSame) {
  for (const double hz : {1e-6, 0.01, 1.0}) {
    const ServoModel believed{2.0 * M_PI * hz, 0.8, 0.004, 1e-3};
    Following state;
    bool found = false;
    for (int i = 0; i < 3000 && !found; ++i) {
      const double v = i < 1000 ? 0.05 : 0.0;
      found = !follows(believed, Point<'R'>(5e-5 * std::min(i, 1000), 0, 0), Vec<'R'>(v, 0, 0),
                       Point<'R'>(0, 0, 0), state);
    }
    EXPECT_TRUE(found) << hz;
  }
}

// What is withheld cannot be followed.
TEST(Following, ADryRunIsNotHeld) {
  Loop loop(prepare(test::plane_scene(), test::exact_rig()));
  loop.tool_tip = Point<'W'>(0.02, 0, 0.03);
  loop.spoil = standing(true);
  loop.tick(1000);
  EXPECT_EQ(loop.out.mode, Mode::follow) << why_text(loop.out.why);
}

trial::TrialResult run(const std::string& scene, const std::vector<std::string>& set, double seconds) {
  trial::TrialOptions options;
  options.seconds = seconds;
  return trial::Trial(models::load(tests::source_dir() + "/models/scenes/" + scene + ".toml", {}, set),
                      options)
      .run();
}

TEST(Following, ATwinWithADeadServoEndsInHold) {
  const trial::TrialResult dead = run("tennis_ball", {"truth.hexapod.servo_hz=1e-6"}, 10.0);
  EXPECT_EQ(dead.last_mode, Mode::hold);
  EXPECT_NE(dead.last_why & kNotFollowing, 0U) << why_text(dead.last_why);
  EXPECT_TRUE(run("tennis_ball", {}, 10.0).holds.empty());
}

// An arm that stays at home, whatever it is told; the finger is at another place of the wall.
TEST(Following, AnArmThatIsStuckIsFoundOutUnderATouchToo) {
  const std::vector<std::string> exact{"rig.tracker.prediction=\"hold\"", "rig.tracker.usual_age_ms=2"};
  trial::FingerLoop loop(
      trial::prepare_setup(models::load(tests::source_dir() + "/models/scenes/wall.toml", "", exact)));
  loop.in.withheld = false;
  for (int i = 0; i < 200; ++i) loop.tick(Point<'W'>(0.060, 0.0, 0.058));
  for (int i = 0; i < 1000; ++i) loop.tick(Point<'W'>(0.060, 0.0, 0.005));  // 3 mm deep, 60 mm from the tip
  EXPECT_EQ(loop.out.mode, Mode::hold);
  EXPECT_NE(loop.out.why & kNotFollowing, 0U) << why_text(loop.out.why);
}

TEST(Following, AnArmThatIsStuckIsHeldUntilTheFingerHasGone) {
  const std::vector<std::string> exact{"rig.tracker.prediction=\"hold\"", "rig.tracker.usual_age_ms=2"};
  trial::FingerLoop loop(
      trial::prepare_setup(models::load(tests::source_dir() + "/models/scenes/wall.toml", "", exact)));
  loop.in.withheld = false;
  const auto at = [&](double gap, int ticks) {
    for (int i = 0; i < ticks; ++i) loop.tick(Point<'W'>(0.060, 0.0, 0.008 + gap));
    return loop.out;
  };
  EXPECT_EQ(at(0.050, 200).mode, Mode::follow) << why_text(loop.out.why);
  EXPECT_EQ(at(0.050, 600).mode, Mode::hold);
  EXPECT_NE(loop.out.why & kNotFollowing, 0U) << why_text(loop.out.why);
  EXPECT_EQ(at(0.050, 2000).mode, Mode::hold);  // and does not try again
  EXPECT_LT(loop.out.felt.norm(), 1e-9);        // gravity alone
  EXPECT_EQ(at(0.150, 10).mode, Mode::away);
  EXPECT_EQ(at(0.050, 200).mode, Mode::follow);  // a fresh reason
}

}  // namespace
}  // namespace enc
