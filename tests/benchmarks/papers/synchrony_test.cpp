// Limits from contact to contact, the fused tip, the lag of two signals, the age of a surface that a display
// sends back. The measure recovers the injected lags; a display that is later by some time lags by exactly
// that time.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "benchmarks/synchrony/sync_trial.h"
#include "core/base/units.h"
#include "core/control/stages/report.h"
#include "core/control/track/reach.h"
#include "core/control/world/object.h"
#include "sim/plants/device_plants.h"
#include "sim/truth/random.h"
#include "tests/support/scenes.h"
#include "tests/support/twin.h"
#include "trial/trial.h"

namespace enc::bench::synchrony {
namespace {

using test::Loop;
using test::scene_file;

TEST(ContactLimits, TheKthContactTakesTheKthAndTheLastStays) {
  const std::vector<double> limits{6 * kMillimetre, 4 * kMillimetre, 2 * kMillimetre};
  const ContactLimits all(limits);
  EXPECT_EQ(all.at(0, 9.0), 6 * kMillimetre);  // before the first contact
  EXPECT_EQ(all.at(1, 9.0), 6 * kMillimetre);
  EXPECT_EQ(all.at(2, 9.0), 4 * kMillimetre);
  EXPECT_EQ(all.at(3, 9.0), 2 * kMillimetre);
  EXPECT_EQ(all.at(400, 9.0), 2 * kMillimetre);
  EXPECT_EQ(ContactLimits().at(3, 9.0), 9.0);
}

// Clear of the ball until the force zero is known, then in contact.
void touch(Loop& loop) {
  loop.force = Vec<'W'>(0, 0, 0);
  loop.tool_tip = Point<'W'>(0, 0, test::kTop + test::kToolRadius + 20 * kMillimetre);
  loop.tick(600);
  loop.tool_tip = Point<'W'>(0, 0, test::kTop + test::kToolRadius - 0.1 * kMillimetre);
  loop.tick(50);
}

TEST(ContactLimits, ThreePressesStopAtThreeDepths) {
  SceneSpec spec = test::ball_scene();
  spec.objects.front().limits = {4 * kMillimetre, 2 * kMillimetre};
  Loop loop(prepare(spec, test::exact_rig()));
  for (const double limit : {4 * kMillimetre, 2 * kMillimetre, 2 * kMillimetre}) {
    touch(loop);
    loop.force = Vec<'W'>(0, 0, -30);
    loop.tick(1500);
    EXPECT_EQ(loop.out.mode, Mode::contact);
    EXPECT_DOUBLE_EQ(loop.out.deflection, limit);
    const double depth = test::kTop - loop.scene.tip_radius - loop.tip().xyz[2];
    EXPECT_NEAR(depth, limit, 10e-6);
  }
  EXPECT_EQ(loop.out.contacts, 3);
}

TEST(Fuse, TheTipIsWhereItTouchesTheHapticTip) {
  const Point<'W'> tip(0.001, 0.002, 0.003);
  const Point<'W'> above = touching(tip, 0.007, Point<'W'>(0.001, 0.002, 0.0101));
  EXPECT_NEAR(above.xyz[2], 0.010, 1e-15);
  const Point<'W'> beside = touching(tip, 0.005, Point<'W'>(0.001 + 0.03, 0.002, 0.003 + 0.04));
  EXPECT_NEAR(beside.xyz[0], 0.004, 1e-15);
  EXPECT_NEAR(beside.xyz[2], 0.007, 1e-15);
  EXPECT_EQ(touching(tip, 0.007, tip).xyz, tip.xyz);
}

TEST(Fuse, TheShareGrowsToTheForceThatIsAContact) {
  EXPECT_EQ(pressing_share(-1.0, 0.1), 0.0);
  EXPECT_EQ(pressing_share(0.0, 0.1), 0.0);
  EXPECT_DOUBLE_EQ(pressing_share(0.025, 0.1), 0.25);
  EXPECT_EQ(pressing_share(5.0, 0.1), 1.0);
}

// The drawn tip under a tracker with an error of 0.12 mm.
Point<'W'> drawn(SeenTip tip, double lead, double compliance, double speed, Loop& loop) {
  loop.scene.display.tip = tip;
  loop.scene.display.lead = lead;
  loop.scene.display.compliance = compliance;
  touch(loop);
  loop.force = Vec<'W'>(0, 0, -6);
  loop.tick(2000);
  loop.tool_tip = loop.tip() + Vec<'W'>(0, 0, 7.12 * kMillimetre);
  loop.spoil = [speed](Inputs& in) { in.tip.value.velocity = Vec<'R'>(0, 0, -speed); };
  loop.tick();
  return loop.out.view.tip;
}

TEST(Fuse, WhileItPressesTheHapticTipSaysWhereTheToolIs) {
  Loop loop(prepare(test::ball_scene(), test::exact_rig()));
  const double z = drawn(SeenTip::fused, 0.0, 0.0, 0.010, loop).xyz[2];
  ASSERT_EQ(loop.out.mode, Mode::contact);
  EXPECT_NEAR(z - loop.in.tip.value.X_RH.p().z() - loop.scene.X_WR.p().z(), 7 * kMillimetre, 1e-12);
  // The markers move with the tip.
  const Tool& tool = loop.scene.tools.front();
  EXPECT_NEAR((loop.out.view.X_WT * tool.tip.centre).xyz[2], z, 1e-12);
}

TEST(Fuse, AheadByTheVelocityAndNearerByWhatGives) {
  Loop now(prepare(test::ball_scene(), test::exact_rig()));
  Loop then(prepare(test::ball_scene(), test::exact_rig()));
  const double z = drawn(SeenTip::fused, 0.0, 0.0, 0.010, now).xyz[2];
  const double ahead = drawn(SeenTip::fused, 0.020, 0.0, 0.010, then).xyz[2];
  EXPECT_NEAR(z - ahead, 0.2 * kMillimetre, 1e-9);
  Loop gives(prepare(test::ball_scene(), test::exact_rig()));
  const double nearer = drawn(SeenTip::fused, 0.0, 10e-6, 0.010, gives).xyz[2];
  EXPECT_NEAR(z - nearer, 10e-6 * 6.0, 1e-7);
}

TEST(Fuse, NoDeeperThanTheLimit) {
  SceneSpec spec = test::ball_scene();
  spec.objects.front().limit = 2 * kMillimetre;
  Loop loop(prepare(spec, test::exact_rig()));
  const double z = drawn(SeenTip::fused, 0.050, 0.0, 0.020, loop).xyz[2];
  EXPECT_NEAR(z, test::kTop + test::kToolRadius - 2 * kMillimetre, 10e-6);
}

TEST(Fuse, TrackedAndPredictedStayTheTrackers) {
  for (const SeenTip tip : {SeenTip::tracked, SeenTip::predicted}) {
    Loop loop(prepare(test::ball_scene(), test::exact_rig()));
    const Point<'W'> seen = drawn(tip, 0.020, 10e-6, 0.010, loop);
    EXPECT_NEAR((seen - loop.tool_tip).norm(), 0.0, 1e-12);
  }
}

// Three presses, each a raised cosine.
std::vector<double> presses(double late, double period, std::size_t n) {
  std::vector<double> all;
  all.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) * period - late - 0.5;
    const double since = t - 2.0 * std::floor(t / 2.0);
    const bool pressed = t > 0.0 && t < 6.0 && since < 1.0;
    all.push_back(pressed ? 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * since) : 0.0);
  }
  return all;
}

TEST(Lag, OfShiftedSignals) {
  const std::vector<double> first = presses(0.0, kMillisecond, 7000);
  for (const double late : {-0.0204, 0.0, 0.001, 0.0137, 0.048}) {
    const std::vector<double> second = presses(late, kMillisecond, 7000);
    EXPECT_NEAR(bench::synchrony::lag_of(first, second, kMillisecond, 0.1), late, 5e-5) << late;
  }
  // A bias and a different amplitude of the signal change nothing.
  std::vector<double> second = presses(0.030, kMillisecond, 7000);
  for (double& x : second) x = 0.2 + 3.0 * x;
  EXPECT_NEAR(bench::synchrony::lag_of(first, second, kMillisecond, 0.1), 0.030, 5e-5);
}

TEST(Lag, ThereIsNoneWithoutASignalOrBeyondTheSearch) {
  const std::vector<double> flat(2000, 1.0);
  const std::vector<double> first = presses(0.0, kMillisecond, 7000);
  EXPECT_TRUE(std::isnan(bench::synchrony::lag_of(flat, flat, kMillisecond, 0.1)));
  EXPECT_TRUE(std::isnan(bench::synchrony::lag_of({}, {}, kMillisecond, 0.1)));
  EXPECT_TRUE(
      std::isnan(bench::synchrony::lag_of(first, presses(0.3, kMillisecond, 7000), kMillisecond, 0.1)));
}

// The core's copy of the drawn surface is as old as the way back plus at most one frame.
TEST(Display, AgeOfASurfaceAtEachFrameRate) {
  SceneSpec spec = test::ball_scene();
  spec.display.emplace();
  const Scene scene = prepare(spec, RigSpec{});
  for (const double rate : {30.0, 60.0, 90.0, 120.0}) {
    sim::DisplayTruth truth;
    truth.rate = rate;
    sim::DisplayPlant display(truth, scene, 5);
    Measurement<DentSample> newest;
    double sum = 0.0, oldest = 0.0, youngest = 1.0;
    int n = 0, packets = 0;
    for (int i = 0; i < 3000; ++i) {
      const Time t{from_seconds(i * kMillisecond)};
      display.advance(t);
      packets += display.poll(newest) ? 1 : 0;
      if (i < 1000) continue;
      const double old = age(t, newest.t);
      sum += old;
      oldest = std::max(oldest, old);
      youngest = std::min(youngest, old);
      ++n;
    }
    EXPECT_NEAR(packets, 3.0 * rate, 2.0) << rate;
    EXPECT_GE(youngest, truth.latency) << rate;
    EXPECT_LE(oldest, truth.latency + 1.0 / rate + kMillisecond) << rate;
    EXPECT_NEAR(sum / n, truth.latency + 0.5 / rate + 0.5 * kMillisecond, 0.6 * kMillisecond) << rate;
  }
}

constexpr double kPeriod = 1e-3;  // s

TEST(SynchronyProperty, AnInjectedDelayIsFoundInNoise) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    sim::Stream random(seed, "lag");
    const double delay = -0.010 + 0.060 * random.uniform();
    const double time = 0.5 + 1.5 * random.uniform();  // s, of a press
    const double bias = 0.2 * (random.uniform() - 0.5);
    const auto depth = [&](double t) {
      double sum = 0.0;
      for (int k = 0; k < 3; ++k) {
        const double since = t - 0.5 - 2.5 * time * k;
        const double in = std::clamp(since / time, 0.0, 1.0);
        const double out = std::clamp((since - 1.2 * time) / time, 0.0, 1.0);
        sum += (6.0 - 2.0 * k) * (MinimumJerk(in).x - MinimumJerk(out).x);
      }
      return sum;
    };
    std::vector<double> first, second;
    for (int i = 0; i * kPeriod < 1.0 + 7.5 * time; ++i) {
      first.push_back(depth(i * kPeriod));
      second.push_back(depth(i * kPeriod - delay) + bias + 0.02 * random.normal3().x());
    }
    EXPECT_NEAR(bench::synchrony::lag_of(first, second, kPeriod, 0.1), delay, 5e-4) << "seed " << seed;
  }
}

bench::synchrony::SyncRun run_with(std::vector<std::string> set, std::uint64_t seed = 3) {
  for (const char* quick :
       {"user.repeats=1", "rig.tracker.prediction=\"hold\"", "rig.display.tip=\"tracked\""})
    set.insert(set.begin(), quick);
  return bench::synchrony::run_sync(models::load(scene_file("synchrony"), "sim", set), seed);
}

TEST(SynchronyProperty, ALaterDisplayShiftsTheRecordAndNothingElse) {
  const bench::synchrony::SyncRun now = run_with({});
  const bench::synchrony::SyncRun later = run_with({"truth.display.latency_ms=20"});
  ASSERT_FALSE(now.held || later.held);
  ASSERT_EQ(now.samples.size(), later.samples.size());
  constexpr std::size_t kLater = 10;  // ticks
  double square = 0.0, n = 0.0;
  for (std::size_t i = 200; i < now.samples.size(); ++i) {
    ASSERT_EQ(later.samples[i].haptic, now.samples[i].haptic);
    ASSERT_EQ(later.samples[i].visual, now.samples[i - kLater].visual) << i;
    if (!now.samples[i].contact) continue;
    const double error = now.samples[i - kLater].visual - now.samples[i].haptic;
    square += error * error;
    n += 1.0;
  }
  EXPECT_NEAR(later.against_haptic().rmse, std::sqrt(square / n), 1e-9);
  EXPECT_NEAR(later.lag() - now.lag(), 0.010, 1e-3);
}

TEST(SynchronyProperty, AToolThatBendsIsSeenDeeperByWhatItBends) {
  const bench::synchrony::SyncRun stiff = run_with({});
  const bench::synchrony::SyncRun bent = run_with({"truth.contact.flexure_um_per_N=10"});
  double seen = 0.0, force = 0.0, n = 0.0;
  for (std::size_t i = 0; i < stiff.samples.size(); ++i) {
    if (stiff.samples[i].force < 5.0) continue;
    seen += bent.samples[i].visual - stiff.samples[i].visual;
    force += stiff.samples[i].force;
    n += 1.0;
  }
  ASSERT_GT(n, 100.0);
  EXPECT_NEAR(seen / n, 10e-6 * force / n, 1e-5);
}

std::uint64_t hash_of(const std::vector<std::string>& set) {
  trial::Trial trial(models::load(scene_file("tennis_ball"), "sim", set), {.seconds = 9.0});
  return trial.run().hash;
}

TEST(SynchronyProperty, WhatIsOffChangesNoBit) {
  const std::uint64_t as_it_is = hash_of({});
  EXPECT_EQ(hash_of({"object.ball.limits_mm=[6]", "user.depths_mm=[6.1]"}), as_it_is);
  EXPECT_EQ(hash_of({"rig.display.tip=predicted", "rig.display.lead_ms=20"}), as_it_is);
  EXPECT_EQ(hash_of({"truth.contact.compliance_um_per_N=0", "truth.hand.tilt_deg=0"}), as_it_is);
  EXPECT_NE(hash_of({"object.ball.limits_mm=[4]"}), as_it_is);
  EXPECT_NE(hash_of({"rig.display.tip=fused"}), as_it_is);
}

}  // namespace
}  // namespace enc::bench::synchrony
