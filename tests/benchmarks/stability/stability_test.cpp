// The slide that judges the certificate, known solutions of the slide without a certificate, the random
// places of spot checks, and who holds a device.
#include "benchmarks/stability/stability.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "benchmarks/stability/slide.h"
#include "core/base/error.h"

namespace enc::bench::stability {
namespace {

// Without a wall the slide is a mass on the hand's spring and damper.
TEST(Slide, HandAloneDiesOutByItsDamper) {
  const Device device{0.1, 0.2, 1e-3, 0.0, 0.1, 4.0, 300.0};
  for (const int steps : {1, 2, 10})
    EXPECT_NEAR(growth(device, {}, {Scheme::rk4, steps}), -4.2 / (2.0 * 0.2), 0.02) << steps;
}

// The force of a soft spring is late by half a period and the delay: a damper of -K (T/2 + t_d).
TEST(Slide, SoftWallGrowsByItsLag) {
  for (const double delay : {0.0, 1e-3, 4e-3}) {
    const Device device{0.1, 0.2, 1e-3, delay};
    const double damper = 0.2 - 50.0 * (0.5e-3 + delay);
    EXPECT_NEAR(growth(device, {50.0, 0.0}, {Scheme::rk4, 1}), -damper / 0.2, 0.02) << delay;
  }
}

TEST(Slide, CriticalIsTheSameAtEveryStep) {
  const Device device{0.1, 0.2, 1e-3, 2e-3};
  const double one = critical(device, 0.0, {Scheme::rk4, 1}, NAN, 1e6);
  EXPECT_NEAR(one, 80.0, 0.5);
  EXPECT_NEAR(critical(device, 0.0, {Scheme::rk4, 10}, one, 1e6), one, 1e-3 * one);
  EXPECT_NEAR(critical(device, 0.0, {Scheme::rk4, 10}, 3.0 * one, 1e6), one, 1e-3 * one);
  EXPECT_TRUE(std::isinf(critical(device, 0.0, {Scheme::rk4, 1}, NAN, 40.0)));
  EXPECT_EQ(critical({0.1, 0.0, 1e-3, 5e-3}, 0.0, {Scheme::rk4, 1}, NAN, 1e4), 0.0);
}

TEST(Slide, LetGoRestsCyclesOrLeaves) {
  Device device{0.1, 0.2, 1e-3, 0.0};
  device.friction = 0.05;
  const Stepping fine{Scheme::rk4, 10};
  EXPECT_EQ(let_go(device, {300.0, 0.0}, fine, 1e-3), Outcome::still);
  EXPECT_EQ(let_go(device, {20000.0, 0.0}, fine, 1e-3), Outcome::away);
  device.damping = 1.0;
  device.count = 0.6e-3;  // 0.3 N over an edge, at 1000 N/m
  EXPECT_EQ(let_go(device, {1000.0, 0.0}, fine, 1e-3), Outcome::cycle);
}

// The amplitude shrinks at first, but not below what the counts sustain.
TEST(Slide, WhatGoesDownToALimitCycleIsWatchedOn) {
  Device device{0.1, 0.16, 1e-3, 0.0};
  device.count = 1e-4;
  EXPECT_EQ(let_go(device, {300.0, 0.0}, {Scheme::rk4, 10}, 5e-3), Outcome::cycle);
}

TEST(Slide, DelayMustBeWholeSteps) {
  EXPECT_THROW(Slide({0.1, 0.2, 1e-3, 0.5e-3}, {}, {Scheme::rk4, 1}, 1.0), Error);
  EXPECT_NO_THROW(Slide({0.1, 0.2, 1e-3, 0.5e-3}, {}, {Scheme::rk4, 2}, 1.0));
}

TEST(Maps, RandomPlacesAreOfTheSeedAndReachEverywhere) {
  BenchContext context;
  const auto one = random_places(context, 3, 400, 1), again = random_places(context, 3, 400, 1);
  context.seed = 2;
  const auto other = random_places(context, 3, 400, 1);
  std::set<std::size_t> panels, delays;
  double least = 1.0, most = 0.0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].share, again[i].share);
    panels.insert(one[i].panel);
    delays.insert(one[i].delay);
    least = std::min(least, one[i].share);
    most = std::max(most, one[i].share);
  }
  EXPECT_NE(one[0].share, other[0].share);
  EXPECT_EQ(panels.size(), 3U);
  EXPECT_EQ(delays.size(), kDelays.size());
  EXPECT_LT(least, 0.02);
  EXPECT_GT(most, 0.98);
  EXPECT_NEAR(about(100.0, 0.0), 100.0 / 30.0, 1e-9);
  EXPECT_NEAR(about(100.0, 1.0), 3000.0, 1e-9);
  EXPECT_EQ(about(1e6, 1.0), kHardest);
}

TEST(Maps, StiffnessesCoverEightDecades) {
  BenchContext context;
  const auto all = stiffnesses(context);
  EXPECT_EQ(all.size(), 9U);
  EXPECT_NEAR(all.front(), 1e-2, 1e-9);
  EXPECT_NEAR(all.back(), 1e6, 1.0);
}

}  // namespace
}  // namespace enc::bench::stability
