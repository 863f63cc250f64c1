// Lags that were put in are found again; a later display is later by just that; what is off changes no bit.
#include <cmath>

#include <gtest/gtest.h>

#include "benchmarks/synchrony/lag.h"
#include "benchmarks/synchrony/sync_trial.h"
#include "core/control/track/minimum_jerk.h"
#include "sim/truth/random.h"
#include "tests/conformance/bench_world.h"
#include "trial/trial.h"

namespace enc::test {
namespace {

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
  trial::TrialOptions options;
  options.seconds = 9.0;
  trial::Trial trial(models::load(scene_file("tennis_ball"), "sim", set), options);
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
}  // namespace enc::test
