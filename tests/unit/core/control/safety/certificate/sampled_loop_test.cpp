// Exact eigenvalues of a sampled wall: against the tables of the virtual wall, against a simulation in time,
// and at the edges of what a loop can be.
#include "core/control/safety/certificate/sampled_loop.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace enc::certificate {
namespace {

SampledLoop wall_with(double damping, double delay) { return {0.1, damping, 1e-3, delay}; }

void expect_within(double value, double expected, double share, const std::string& what) {
  EXPECT_NEAR(value, expected, share * expected) << what;
}

TEST(SampledLoop, UndampedWallIsStableUpToTheTable) {
  struct {
    double damping, delay_ms, exact, tolerance;
  } const rows[] = {{0.05, 0, 100.0, 0.005}, {0.2, 0, 400.1, 0.005}, {0.2, 1, 133.4, 0.005},
                    {0.2, 2, 80.1, 0.005},   {0.2, 5, 36.4, 0.005},  {0.2, 10, 19.1, 0.005},
                    {1.0, 0, 2003, 0.005},   {1.0, 2, 402, 0.005},   {1.0, 10, 96.9, 0.005}};
  for (const auto& row : rows)
    expect_within(critical_stiffness(wall_with(row.damping, row.delay_ms * 1e-3)), row.exact, row.tolerance,
                  testing::PrintToString(row.damping) + " " + testing::PrintToString(row.delay_ms));
}

TEST(SampledLoop, WallDamperIsStableUpToTheTable) {
  const double delays[] = {0, 1, 2, 5, 10};
  struct {
    double damper, exact[5];
  } const rows[] = {{0.5, {1394, 464, 278, 126, 65.6}},
                    {2, {4314, 1435, 856, 382, 193}},
                    {10, {18465, 6043, 3490, 1362, 449}},
                    {20, {33073, 10436, 5631, 1334, 0}}};
  for (const auto& row : rows)
    for (std::size_t i = 0; i < 5; ++i)
      expect_within(critical_stiffness(wall_with(0.2, delays[i] * 1e-3), {row.damper, 0.0}), row.exact[i],
                    0.005, testing::PrintToString(row.damper) + " " + testing::PrintToString(delays[i]));
}

TEST(SampledLoop, DamperThatIsUnstableByItselfLeavesNoStiffness) {
  const SampledLoop loop = wall_with(0.2, 10e-3);
  const Range range = stable_range(loop, {20.0, 0.0});
  EXPECT_EQ(range.low, 0.0);
  EXPECT_EQ(range.high, 0.0);
  for (double k = 1e-3; k < 1e8; k *= 1.3) EXPECT_GT(spectral_radius(loop, k, 20.0), 1.0) << k;
}

TEST(SampledLoop, HandRaisesTheBoundToTheTable) {
  const double exact[] = {8431, 2818, 1698, 784, 425}, delays[] = {0, 1, 2, 5, 10};
  for (std::size_t i = 0; i < 5; ++i) {
    SampledLoop loop = wall_with(0.2, delays[i] * 1e-3);
    loop.hand = {0.1, 4.0, 300.0};
    expect_within(critical_stiffness(loop), exact[i], 0.005, testing::PrintToString(delays[i]));
    EXPECT_LT(critical_stiffness(loop.alone()), critical_stiffness(loop));
  }
}

TEST(SampledLoop, StiffnessOnEitherSideOfTheBoundIsStableAndIsNot) {
  for (const double part : {0.0, 0.25, 0.5, 0.999, 1.0, 2.7})
    for (const double damper : {0.0, 0.3}) {
      const SampledLoop loop = wall_with(0.3, part * 1e-3);
      const double k = critical_stiffness(loop, {damper, 0.0});
      EXPECT_TRUE(stable(loop, k * 0.9999, damper)) << part;
      EXPECT_FALSE(stable(loop, k * 1.0001, damper)) << part;
      const double scaled = critical_stiffness(loop, {0.0, 1e-4});
      EXPECT_TRUE(stable(loop, scaled * 0.9999, 1e-4 * scaled * 0.9999)) << part;
      EXPECT_FALSE(stable(loop, scaled * 1.0001, 1e-4 * scaled * 1.0001)) << part;
    }
}

TEST(SampledLoop, BoundFallsWithDelayAndPeriodAndRisesWithDamping) {
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 40; ++i) {
    const double k = critical_stiffness(wall_with(0.2, 0.25e-3 * i));
    EXPECT_LT(k, before) << i;
    before = k;
  }
  before = std::numeric_limits<double>::infinity();
  for (const double period : {1e-4, 3e-4, 1e-3, 3e-3, 1e-2}) {
    const double k = critical_stiffness({0.1, 0.2, period, 1e-3});
    EXPECT_LT(k, before) << period;
    before = k;
  }
  before = 0.0;
  for (const double damping : {0.01, 0.1, 1.0, 5.0}) {
    const double k = critical_stiffness(wall_with(damping, 1e-3));
    EXPECT_GT(k, before) << damping;
    before = k;
  }
}

// Late by five eighths of the hand's own swing a damper drives it and a spring damps it: what is stable does
// not begin at nothing.
TEST(SampledLoop, StableStiffnessesNeedNotBeginAtNothing) {
  SampledLoop loop{0.1, 0.1, 1e-3, 33.5e-3};
  loop.hand = {0.05, 0.1, 2000.0};
  const double damper = 0.5;
  const Range range = stable_range(loop, {damper, 0.0});
  EXPECT_GT(range.low, 10.0);
  ASSERT_GT(range.high, 1.1 * range.low);
  EXPECT_FALSE(stable(loop, 0.5 * range.low, damper));
  for (const double share : {0.001, 0.3, 0.9, 0.999})
    EXPECT_TRUE(stable(loop, range.low + share * (range.high - range.low), damper)) << share;
  for (const double beside : {0.999 * range.low, 1.001 * range.high})
    EXPECT_FALSE(stable(loop, beside, damper)) << beside;
}

// ---- against time
// ----------------------------------------------------------------------------------------

// The same loop, written down as it runs: short steps of Runge and Kutta, a law that keeps what it read.
struct InTime {
  const SampledLoop& loop;
  double stiffness, damper, x = 1.0, v = 0.0, error = 1.0, rate = 0.0;
  std::vector<double> readings{}, forces{};

  void glide(double force, double span) {
    const double m = loop.mass + loop.hand.mass, c = loop.damping + loop.hand.damping;
    const auto a = [&](double at, double speed) {
      return (force - c * speed - loop.hand.stiffness * at) / m;
    };
    const int parts = std::max(4, static_cast<int>(std::ceil(span * c / m / 0.05)));
    const double h = span / parts;
    for (int i = 0; i < parts && span > 0.0; ++i) {
      const double a1 = a(x, v), v2 = v + 0.5 * h * a1, a2 = a(x + 0.5 * h * v, v2), v3 = v + 0.5 * h * a2;
      const double a3 = a(x + 0.5 * h * v2, v3), v4 = v + h * a3, a4 = a(x + h * v3, v4);
      x += h * (v + 2.0 * v2 + 2.0 * v3 + v4) / 6.0;
      v += h * (a1 + 2.0 * a2 + 2.0 * a3 + a4) / 6.0;
    }
  }
  void tick() {
    readings.push_back(x);
    const std::size_t n = static_cast<std::size_t>(loop.ticks), now = readings.size() - 1;
    const double slope = (x - readings[now > n ? now - n : 0]) / (loop.ticks * loop.period), a = loop.filter;
    error = std::isnan(a) ? x : (a * x + error) / (1.0 + a);
    rate = std::isnan(a) ? slope : (a * slope + rate) / (1.0 + a);
    forces.push_back(-stiffness * error - damper * rate);
    const double periods = loop.delay / loop.period;
    const auto whole = static_cast<std::size_t>(periods);
    const double part = periods - static_cast<double>(whole);
    const auto force = [&](std::size_t back) { return now >= back ? forces[now - back] : 0.0; };
    glide(force(whole + 1), part * loop.period);
    glide(force(whole), (1.0 - part) * loop.period);
  }
};

// By how much a swing grows in a period, late in a run.
double growth(const SampledLoop& loop, double stiffness, double damper) {
  InTime run{loop, stiffness, damper};
  const double w = std::max(ringing(loop, stiffness, damper), 20.0);
  const int swing = std::max(20, static_cast<int>(2.0 * M_PI / w / loop.period) + 1), ticks = 40 * swing;
  double early = 0.0, late_one = 0.0;
  for (int i = 0; i < ticks; ++i) {
    run.tick();
    if (i >= ticks / 2 && i < ticks / 2 + 2 * swing) early = std::max(early, std::abs(run.x));
    if (i >= ticks - 2 * swing) late_one = std::max(late_one, std::abs(run.x));
  }
  return std::pow(late_one / early, 1.0 / (ticks - 2 * swing - ticks / 2));
}

TEST(SampledLoop, RadiusIsWhatTwoHundredSimulatedLoopsDo) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int judged = 0;
  for (int i = 0; i < 200; ++i) {
    SampledLoop loop{0.05 * std::pow(20.0, unit(random)), 0.02 * std::pow(100.0, unit(random)),
                     unit(random) < 0.5 ? 1e-3 : 0.4e-3};
    loop.delay = unit(random) < 0.3 ? 0.0 : 6e-3 * unit(random);
    loop.ticks = 1 + static_cast<int>(3.0 * unit(random));
    if (unit(random) < 0.4) loop.filter = 0.1 + unit(random);
    if (unit(random) < 0.4) loop.hand = {0.1 * unit(random), 4.0 * unit(random), 400.0 * unit(random)};
    const Damper damper{unit(random) < 0.5 ? 0.0 : loop.damping * unit(random), 0.0};
    const double critical = critical_stiffness(loop, damper);
    if (!(critical > 0.0)) continue;
    ++judged;
    for (const double times : {0.9, 1.1}) {
      const double k = times * critical, radius = spectral_radius(loop, k, damper.fixed);
      EXPECT_EQ(radius > 1.0, times > 1.0) << i;
      EXPECT_NEAR(growth(loop, k, damper.fixed), radius, 0.02 * std::abs(radius - 1.0) + 3e-4) << i;
    }
  }
  EXPECT_GT(judged, 190);
}

// ---- edges
// -----------------------------------------------------------------------------------------------

TEST(SampledLoop, UndampedIsStableForNoStiffness) {
  EXPECT_EQ(critical_stiffness(wall_with(0.0, 0.0)), 0.0);
  EXPECT_EQ(critical_stiffness(wall_with(0.0, 5e-3)), 0.0);
}

TEST(SampledLoop, WhatIsNotKnownHasNoAnswer) {
  const double nan = kUnset, inf = std::numeric_limits<double>::infinity();
  std::vector<SampledLoop> wrong{{nan, 0.2, 1e-3},
                                 {0.0, 0.2, 1e-3},
                                 {-0.1, 0.2, 1e-3},
                                 {0.1, nan, 1e-3},
                                 {0.1, -0.2, 1e-3},
                                 {0.1, 0.2, nan},
                                 {0.1, 0.2, 0.0},
                                 {0.1, 0.2, -1e-3},
                                 {0.1, 0.2, 1e-3, nan},
                                 {0.1, 0.2, inf},
                                 {0.1, 0.2, 1e-3, -1e-3},
                                 {0.1, 0.2, 1e-3, inf},
                                 {0.1, 0.2, 1e-3, 0.6011},
                                 {inf, 0.2, 1e-3},
                                 {0.1, 0.2, 1e-3, 0, 0},
                                 {0.1, 0.2, 1e-3, 0, 1, 0.0},
                                 {0.1, 0.2, 1e-3, 0, 1, -1.0}};
  SampledLoop held = wall_with(0.2, 0.0);
  held.hand.stiffness = -1.0;
  wrong.push_back(held);
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    EXPECT_FALSE(wrong[i].known()) << i;
    EXPECT_TRUE(std::isnan(critical_stiffness(wrong[i]))) << i;
    EXPECT_TRUE(std::isnan(spectral_radius(wrong[i], 100.0, 0.0))) << i;
    EXPECT_FALSE(stable(wrong[i], 100.0, 0.0)) << i;
  }
  EXPECT_TRUE(std::isnan(critical_stiffness(wall_with(0.2, 0.0), {nan, 0.0})));
  EXPECT_FALSE(stable(wall_with(0.2, 0.0), nan, 0.0));
}

TEST(SampledLoop, SameDelayInOneFormOrAnother) {
  // 3 periods less a part that no clock has, and 3 periods.
  EXPECT_NEAR(critical_stiffness(wall_with(0.2, 3e-3)), critical_stiffness(wall_with(0.2, 3e-3 - 1e-12)),
              1e-6);
  EXPECT_NEAR(critical_stiffness(wall_with(0.2, 3e-3)), critical_stiffness(wall_with(0.2, 3e-3 - 1e-8)),
              1e-2);
}

}  // namespace
}  // namespace enc::certificate
