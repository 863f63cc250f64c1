// The energy that a law gives out: what is observed, what is left, and what of a push is given. Values worked
// by hand.
#include "core/control/safety/passivity/passivity.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace enc {
namespace {

// Of what may be given out: g = 1 mm/N, so a kilogram in sqrt(2e-3) s.
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
  observe(now, {0.5e-3, 0.5e-3, 4.0}, 0.0);  // back by half: 1.5 mJ out, 1 mJ less than was asked for
  EXPECT_DOUBLE_EQ(now.given, -0.5e-3);
  EXPECT_DOUBLE_EQ(now.left, 0.5e-3);
  EXPECT_DOUBLE_EQ(now.stored, 1e-3);
  EXPECT_DOUBLE_EQ(now.dissipated, 1e-3);
  EXPECT_DOUBLE_EQ(now.most, 2.0);
}

// A long press puts much into the law's damper. That does not come back, and hides nothing.
TEST(Passivity, WhatADamperTookIsNotLeft) {
  Passivity now;
  begin(now, {0.0, 0.0, 0.0}, 0.0);
  double depth = 0.0;
  for (int i = 0; i < 1000; ++i) {
    hold(now, 4.0, 4.0);
    const double before = depth;
    depth = i % 2 == 0 ? 2e-3 : 1e-3;
    if (i % 2 == 1) now.pushed = 1.0;  // in against 4 N, out with 1 N
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

// A push is lessened, never turned round: the person would be pulled where the law pushes.
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

// An encoder that counts by 1 mm: it is half a count farther in, for all that is known, and a reading that
// turns by one count is no way.
TEST(Passivity, ACountIsNoMotion) {
  constexpr double kCount = 1e-3;
  EXPECT_DOUBLE_EQ(given(0.0, 0.0, 9.0, kCount), 0.5) << "half a count farther in, for all that is known";
  EXPECT_DOUBLE_EQ(given(-0.02e-3, 0.0, 9.0, kCount), 0.5) << "and where little is owed for that";
  EXPECT_DOUBLE_EQ(given(-0.04e-3, 0.0, 9.0, kCount), 0.0) << "but no more";
  Passivity now = with(1e-3);
  for (int i = 0; i < 100; ++i) {
    const double push = i % 2 == 0 ? 2.0 : 1.0;  // 1 mJ each time, if it were a way
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

// A mass of 0.1 kg at 1 kHz, whatever the law asks for. What pushes it besides is not foreseen: only by its
// work may the energy pass what there was.
TEST(Passivity, AnyLawOnAnyWalkStaysWithinWhatThereWas) {
  constexpr double kPerNewton = 5e-6;
  std::mt19937_64 draw(20);
  std::normal_distribution<double> normal;
  for (int walk = 0; walk < 300; ++walk) {
    const double pushes = walk % 3 == 0 ? 0.0 : std::exp(normal(draw) - 10.0);  // m, what is not foreseen
    const double stiffness = std::exp(8.0 + 3.0 * normal(draw)), wild = walk % 2 == 0 ? 0.0 : 8.0;
    double depth = 1e-3, u = 1e-4 * normal(draw), out = 0.0, excused = 0.0, most = 0.0;
    Passivity now;
    begin(now, {u, depth, stiffness * depth}, std::abs(normal(draw)) * 1e-3);
    const double held = now.left;
    for (int i = 0; i < 2000; ++i) {
      const double asked = std::clamp(stiffness * depth + wild * normal(draw), -8.5, 8.5);
      const double push = passive(now, asked, kPerNewton, 0.0);
      hold(now, push, asked);
      const double missed = pushes * normal(draw);
      const double way = u + kPerNewton * push + missed;
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

// Of a machine that is sent to places.
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

}  // namespace
}  // namespace enc
