// A finger that comes is met where it will touch, in haste, as long as pictures can show that; and an arm
// that rests afterwards pushes nothing. The core alone, finger and arm are where a test puts them.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/finger_bench.h"

namespace enc {
namespace {

using Bench = test::FingerBench;

// A finger that is at z = `gap` above the wall at 0.5 s, seen at 20 Hz and 50 ms late.
struct Comes {
  Vec3 velocity{0.1, 0.0, -0.2};
  double gap = 0.0;
  [[nodiscard]] Point<'W'> at(double t) const {
    return Point<'W'>(Vec3(0.0, 0.0, 0.008 + gap) + (t - 0.5) * velocity);
  }
};

struct Gone {
  Point<'W'> wanted;                     // where the prop is sent in the end
  double in_haste = 0.0, without = 0.0;  // m/s^2: most of the target
  double foreseen_way = 0.0;             // m: from that to where the finger's projection is
};

Gone meet(const Comes& finger, double until, const std::vector<std::string>& more = {}) {
  std::vector<std::string> set{"rig.tracker.prediction=\"constant_velocity\"",
                               "rig.tracker.usual_age_ms=110"};
  set.insert(set.end(), more.begin(), more.end());
  Bench bench("wall", set);
  Gone gone;
  const double dt = bench.loop.scene.dt;
  Vec3 before = Vec3::Zero();
  for (int i = 0; 0.001 * i < until; ++i) {
    i % 50 == 0 ? bench.loop.see(finger.at(0.001 * (i - 50)), std::chrono::milliseconds(50))
                : bench.loop.tick();
    const Aim& now = recall<Meeting>(bench.loop.state).aim;
    const double change = (now.velocity.e() - before).norm() / dt;
    before = now.velocity.e();
    double& most = now.hurried ? gone.in_haste : gone.without;
    most = std::max(most, change);
  }
  gone.wanted = bench.loop.out.wanted;
  gone.foreseen_way = (gone.wanted.e() - finger.at(until).e()).head<2>().norm();
  return gone;
}

TEST(Coming, PicturesThatAreTooVagueForeseeNothing) {
  const auto with_noise = [](double noise, double vaguest) {
    return meet({}, 0.45,
                {fmt::format("rig.tracker.measurement_noise_mm={}", noise),
                 fmt::format("rig.tracker.reach.vaguest_mm={}", vaguest)})
        .wanted.xyz[0];
  };
  EXPECT_NEAR(with_noise(0.5, 1.1), 0.0, 1e-3);     // it will touch at x = 0
  EXPECT_NEAR(with_noise(1.2, 1.1), -0.005, 1e-3);  // it is at x = -5 mm
  EXPECT_GT(with_noise(1.2, 1.3), -0.004);
}

// x of where the prop is sent, of a finger whose picture i says that it is so vague, m; below 0: there is
// none.
double sent_x(const std::function<double(int)>& vague) {
  Bench bench("wall", {"rig.tracker.prediction=\"constant_velocity\"", "rig.tracker.usual_age_ms=110"});
  for (int i = 0; i < 450; ++i) {
    const double noise = vague(i / 50);
    if (i % 50 != 0 || noise < 0.0) {
      bench.loop.tick();
      continue;
    }
    bench.loop.put(Comes{}.at(0.001 * (i - 50)));
    bench.loop.in.tool.t -= std::chrono::milliseconds(50);
    TrackedTool& seen = bench.loop.in.tool.value;
    seen.along = seen.across = noise;
    bench.loop.go();
  }
  return bench.loop.out.wanted.xyz[0];
}
double sent_x(double even, double odd) {
  return sent_x([&](int i) { return i % 2 == 0 ? even : odd; });
}

// What a picture says of itself counts, and not what the rig says of pictures.
TEST(Coming, HowVagueAPictureIsItSaysItself) {
  for (const auto& [noise, x] : {std::pair{0.5e-3, 0.0}, {1.5e-3, -0.005}, {kUnset, 0.0}})
    EXPECT_NEAR(sent_x(noise, noise), x, 1e-3) << noise;
}

TEST(Coming, WhatIsAboutAsVagueAsMayBeIsNotAskedNowAndThen) {
  // The last of them, at 400 ms, is an even one.
  EXPECT_NEAR(sent_x(1.15e-3, 1.05e-3), 0.0, 1e-3);
  EXPECT_LT(sent_x(1.25e-3, 1.05e-3), -0.003) << "on its way back";
  EXPECT_NEAR(sent_x(1.15e-3, 1.15e-3), -0.005, 1e-3);
}

TEST(Coming, HowClearOldPicturesWereIsForgottenWithThem) {
  const auto from = [](int first, double then) {  // of the new ones, after 50 ms times `first`
    return sent_x([&, then](int i) { return i < 2 ? 1.05e-3 : i < first ? -1.0 : then; });
  };
  EXPECT_NEAR(from(4, 1.15e-3), 0.0, 1e-3) << "the same finger, seen on";
  EXPECT_NEAR(from(6, 1.05e-3), 0.0, 1e-3);
  EXPECT_NEAR(from(6, 1.15e-3), -0.005, 1e-3) << "unseen for longer than it is believed to go on";
}

TEST(Coming, AFingerThatHoversIsMetUnderWhereItIs) {
  const Comes hovers{{0.1, 0.0, -0.04}, 0.020};
  EXPECT_LT(meet(hovers, 0.5).foreseen_way, 1.5e-3);
  const Comes comes{{0.1, 0.0, -0.2}, 0.020};  // in 100 ms, 10 mm on
  EXPECT_GT(meet(comes, 0.5).foreseen_way, 5e-3);
}

TEST(Coming, OnlyToWhereAReachMayTouchTheTargetHurries) {
  Bench bench("wall");
  const ArmRig& rig = bench.loop.scene.impedance()->rig;
  ASSERT_LT(rig.acceleration, rig.reach_acceleration);
  const Gone reach = meet({}, 0.45);
  EXPECT_GT(reach.in_haste, rig.acceleration * 1.1);
  EXPECT_LE(reach.in_haste, rig.reach_acceleration * 1.001);
  EXPECT_LE(reach.without, rig.acceleration * 1.001);
  for (const Gone& gone :
       {meet({}, 0.45, {"rig.tracker.foresight=\"carried_on\""}), meet({{0.1, 0.0, -0.04}, 0.020}, 0.5)}) {
    EXPECT_EQ(gone.in_haste, 0.0);
    EXPECT_LE(gone.without, rig.acceleration * 1.001);
  }
}

// x of the key that a prop is sent to, 0.13 s before a finger that comes obliquely touches at x = 0.
double key_x(const char* foresight) {
  Bench bench("keypad", {"rig.tracker.prediction=\"constant_velocity\"", "rig.tracker.usual_age_ms=110",
                         fmt::format("rig.tracker.foresight=\"{}\"", foresight)});
  const double y = bench.loop.scene.objects[0].X_WO.origin().xyz[1];
  const Comes finger{{0.2, 0.0, -0.2}, 0.0};
  for (int i = 0; i < 370; ++i) {
    const Point<'W'> at = finger.at(0.001 * (i - 50)) + Vec<'W'>(0.0, y, 0.0);
    i % 50 == 0 ? bench.loop.see(at, std::chrono::milliseconds(50)) : bench.loop.tick();
  }
  return bench.loop.scene.objects[static_cast<std::size_t>(bench.loop.out.object)].X_WO.origin().xyz[0];
}

TEST(Coming, AKeyIsChosenByWhereTheFingerWillTouch) {
  EXPECT_NEAR(key_x("reach"), 0.0, 1e-9);
  EXPECT_NEAR(key_x("carried_on"), -0.020, 1e-9) << "by where it is in 60 ms";
}

// What haste set in motion it brakes: where the finger that it went to meet has stopped, the target does not
// shoot past what it may brake within.
TEST(Coming, HasteBrakesWhatItSetInMotion) {
  Bench bench("wall", {"rig.tracker.prediction=\"constant_velocity\"", "rig.tracker.usual_age_ms=110"});
  const ArmRig& rig = bench.loop.scene.impedance()->rig;
  const Comes finger{{0.3, 0.0, -0.3}, 0.0};
  double braked = 0.0, slow = 0.0;
  Vec3 before = Vec3::Zero();
  for (int i = 0; i < 700; ++i) {
    const double t = std::min(0.001 * (i - 50), 0.40);  // it stops in the air
    i % 50 == 0 ? bench.loop.see(finger.at(t), std::chrono::milliseconds(50)) : bench.loop.tick();
    const Aim& now = recall<Meeting>(bench.loop.state).aim;
    const double change = (now.velocity.norm() - before.norm()) / bench.loop.scene.dt;
    before = now.velocity.e();
    double& most = now.hurried ? braked : slow;
    most = std::min(most, change);
  }
  EXPECT_LT(braked, -1.1 * rig.acceleration);
  EXPECT_GE(braked, -1.001 * rig.reach_acceleration);
  EXPECT_GE(slow, -1.001 * rig.acceleration);
}

// The tip 2 mm from its target when the finger has gone: friction holds it.
double pushed_after_rest(const std::vector<std::string>& set, bool slips = false) {
  Bench bench("wall", set);
  bench.at(-0.050, 50);
  bench.press_tip(0.002);
  bench.at(-0.050, 200);
  EXPECT_NEAR(bench.pushed(), 0.6, 0.01);
  bench.at(-0.150, 1);
  const double soon = bench.pushed();
  EXPECT_GT(soon, 0.5);  // nothing leaps
  if (slips) {           // by 0.2 mm, with the speed that one count says
    bench.press_tip(0.0022);
    bench.loop.in.arm.value.velocity = Vec<'R'>(Vec3(0.0, 0.0, -0.014));
    bench.at(-0.150, 1);
    bench.loop.in.arm.value.velocity = Vec<'R'>::zero();
  }
  bench.at(-0.150, 1000);
  EXPECT_LE(bench.pushed(), std::max(soon, 0.7));
  return bench.pushed();
}

TEST(Coming, WhatPushesAnArmThatRestsFades) {
  Bench bench("wall");
  for (int again = 0; again < 2; ++again) {  // after a slip, too, when a finger has come and gone
    bench.press_tip(0.002);
    bench.at(-0.050, 200);
    int ticks = 0;
    while (!recall<Meeting>(bench.loop.state).aim.stood.finite() && ++ticks < 100) bench.at(-0.150, 1);
    const double before = bench.pushed();
    EXPECT_GT(before, 0.55) << ticks;
    bench.at(-0.150, 50);
    EXPECT_NEAR(bench.pushed(), before * std::exp(-1.0), 0.02 * before);
    bench.press_tip(0.0025);
    bench.at(-0.150, 500);
    EXPECT_NEAR(bench.pushed(), 0.75, 0.02);
  }
  EXPECT_NEAR(pushed_after_rest({}), 0.0, 1e-6);
  EXPECT_NEAR(pushed_after_rest({}, true), 0.66, 0.01) << "it slipped: friction does not hold it alone";
  EXPECT_NEAR(pushed_after_rest({"rig.arm.gravity=\"published\""}), 0.6, 0.01) << "it may hold a weight";
}

}  // namespace
}  // namespace enc
