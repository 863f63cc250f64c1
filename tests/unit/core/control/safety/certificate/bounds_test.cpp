// The formulas of the literature, against their closed forms and against the exact boundary.
#include "core/control/safety/certificate/bounds.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace enc::certificate {
namespace {

SampledLoop wall(double damping, double delay = 0.0) { return {0.1, damping, 1e-3, delay}; }
const SampledLoop kPhantom{0.075, 0.0114, 1e-3};  // at 0.21 m
const Steps kCounts{0.048, 28.7e-6};

TEST(Bounds, ColgateSchenkelOfASpringAndADamperIsTheClosedForm) {
  for (const double k : {0.0, 10.0, 300.0, 5000.0})
    for (const double damper : {-1.0, -0.1, 0.0, 0.05, 0.3, 4.0})
      EXPECT_NEAR(needed_damping(wall(0.2), k, damper), std::max(0.0, k * 0.5e-3 + std::abs(damper)), 1e-6)
          << k << " " << damper;
  EXPECT_NEAR(passive_stiffness(wall(0.2), {}), 400.0, 1e-3);
  EXPECT_NEAR(passive_stiffness(wall(0.2), {0.05, 0.0}), 300.0, 1e-3);
  EXPECT_EQ(passive_stiffness(wall(0.2), {0.25, 0.0}), 0.0);
  EXPECT_NEAR(passive_stiffness(wall(0.2), {0.0, 5e-4}), 200.0, 1e-3);  // b = K (T/2 + ratio)
  EXPECT_EQ(passive_stiffness(wall(0.0), {}), 0.0);
}

TEST(Bounds, ColgateSchenkelWithDelayIsHalfAPeriodAndTheDelay) {
  for (const double delay : {1e-3, 2e-3, 5e-3, 10e-3})
    EXPECT_NEAR(passive_stiffness(wall(0.2, delay), {}), 0.2 / (0.5e-3 + delay), 0.01) << delay;
}

// A part of a period: never more than with the period below, never less than with the one above, and what is
// needed is exactly what the largest stiffness needs.
TEST(Bounds, ColgateSchenkelBetweenPeriods) {
  double before = passive_stiffness(wall(0.2), {});
  for (int i = 1; i <= 30; ++i) {
    const SampledLoop loop = wall(0.2, 0.1e-3 * i);
    for (const Damper& damper : {Damper{}, Damper{0.02, 0.0}, Damper{0.0, 1e-4}}) {
      const double k = passive_stiffness(loop, damper);
      EXPECT_NEAR(needed_damping(loop, k, damper.at(k)), 0.2, 1e-4) << i;
    }
    const double k = passive_stiffness(loop, {});
    EXPECT_LE(k, before) << i;
    before = k;
  }
}

TEST(Bounds, PassiveIsStableWithAnyHand) {
  for (const double delay : {0.0, 0.4e-3, 1e-3, 3.3e-3})
    for (const int ticks : {1, 3})
      for (const double filter : {kUnset, 0.4}) {
        SampledLoop loop{0.1, 0.5, 1e-3, delay, ticks, filter};
        const Damper damper{0.05, 0.0};
        const double k = passive_stiffness(loop, damper);
        ASSERT_GT(k, 0.0);
        for (const double mass : {0.001, 0.1, 10.0})
          for (const double stiffness : {0.0, 30.0, 3000.0, 3e5}) {
            loop.mass = mass;
            loop.hand = {0.01, 0.0, stiffness};
            EXPECT_TRUE(stable(loop, 0.999 * k, damper.fixed)) << delay << " " << mass << " " << stiffness;
          }
      }
}

TEST(Bounds, AbbottOkamuraOfThePhantom) {
  EXPECT_NEAR(quantised_stiffness(kPhantom, kCounts), 22.8, 1e-9);
  // 3324 N/m of figures that are printed with two and three digits.
  EXPECT_NEAR(quantised_stiffness({0.075, 100.0, 1e-3}, kCounts), 3324.0, 0.01 * 3324.0);
  EXPECT_EQ(quantised_stiffness(kPhantom, {0.0, 1e-5}), 0.0);
  EXPECT_NEAR(quantised_stiffness(kPhantom, {0.0, 0.0}), 22.8, 1e-9);
  EXPECT_TRUE(std::isnan(quantised_stiffness(kPhantom, {kUnset, 1e-5})));
  EXPECT_TRUE(std::isnan(quantised_stiffness(kPhantom, {0.1, -1e-5})));
}

TEST(Bounds, GilHulinOfTheTableAndItsError) {
  struct {
    double damper, delay_ms, formula, exact;
  } const rows[] = {{0.5, 0, 1400, 1394}, {0.5, 10, 66.7, 65.6}, {2, 0, 4400, 4314}, {2, 5, 400, 382},
                    {10, 1, 6800, 6043},  {10, 5, 1855, 1362},   {10, 10, 971, 449}, {20, 0, 40400, 33073},
                    {20, 5, 3673, 1334},  {20, 2, 8081, 5631}};
  for (const auto& row : rows) {
    const SampledLoop loop = wall(0.2, row.delay_ms * 1e-3);
    const Damper damper{row.damper, 0.0};
    EXPECT_NEAR(delayed_stiffness(loop, damper), row.formula, 0.002 * row.formula);
    const double error = delayed_stiffness(loop, damper) / critical_stiffness(loop, damper) - 1.0;
    EXPECT_NEAR(error, row.formula / row.exact - 1.0, 0.01) << row.damper << " " << row.delay_ms;
  }
  EXPECT_NEAR(delayed_stiffness(wall(0.2, 20e-3), {20.0, 0.0}), 985.0, 1.0);  // where none is stable
  EXPECT_NEAR(delayed_stiffness(wall(0.2), {0.0, 2.5e-4}), 800.0, 1e-6);
  EXPECT_TRUE(std::isinf(delayed_stiffness(wall(0.2), {0.0, 1e-3})));
}

TEST(Bounds, PlaneOfDiolaiti) {
  const Steps steps{0.05, 1e-4};  // 1000 N/m by its counts
  EXPECT_EQ(plane_of(wall(0.2), steps, {300.0, {}}).region, Region::passive);
  EXPECT_EQ(plane_of(wall(0.2), steps, {600.0, {}}).region, Region::locally_stable);
  EXPECT_EQ(plane_of(wall(0.2), steps, {1100.0, {}}).region, Region::unstable);
  EXPECT_EQ(plane_of(wall(2.0), steps, {1100.0, {}}).region, Region::limit_cycle);
  const Plane at = plane_of(wall(0.2), steps, {400.0, {}});
  EXPECT_NEAR(at.beta, 0.5, 1e-12);
  EXPECT_NEAR(at.sigma, 1.25, 1e-12);
  EXPECT_EQ(plane_of(wall(kUnset), steps, {1.0, {}}).region, Region::unknown);
  EXPECT_EQ(plane_of(wall(0.2), {kUnset, 0.0}, {1.0, {}}).region, Region::unknown);
  // Of a loop that is no plain spring it says nothing.
  EXPECT_EQ(plane_of(wall(0.2, 2e-3), steps, {300.0, {}}).region, Region::unknown);
  EXPECT_EQ(plane_of(wall(0.2), steps, {300.0, {0.1, 0.0}}).region, Region::unknown);
  EXPECT_EQ(plane_of({0.1, 0.2, 1e-3, 0.0, 1, 0.4}, steps, {300.0, {}}).region, Region::unknown);
}

// Where delays are short for the device it is within 5 %; beyond that it is not, and does not apply.
TEST(Bounds, GilHulinIsCloseWhereItApplies) {
  int applied = 0;
  double beyond = 0.0;
  for (const double mass : {0.01, 0.075, 1.0})
    for (const double b : {0.05, 0.2, 1.0, 5.0})
      for (const double share : {0.0, 0.5, 1.0})
        for (const double delay : {0.0, 1e-3, 3.3e-3, 10e-3}) {
          const SampledLoop loop{mass, b, 1e-3, delay};
          const Damper damper{share * b, 0.0};
          const Row row = bounds(loop, {0.0, 0.0}, {1.0, damper})[2];
          const double error = row.bound / critical_stiffness(loop, damper) - 1.0;
          if (!row.applies) {
            beyond = std::max(beyond, error);
            continue;
          }
          ++applied;
          EXPECT_LT(std::abs(error), 0.05) << mass << " " << b << " " << share << " " << delay;
        }
  EXPECT_GT(applied, 50);
  EXPECT_GT(beyond, 0.15);
}

// The margin of a loop that is stable between two stiffnesses is below 1 beneath both.
TEST(Bounds, MarginTellsWhereWhatIsStableDoesNotBeginAtNothing) {
  SampledLoop loop{0.1, 0.1, 1e-3, 33.5e-3};
  loop.hand = {0.05, 0.1, 2000.0};
  const Damper damper{0.5, 0.0};
  const Range range = stable_range(loop, damper);
  const auto row = [&](double stiffness) { return bounds(loop, kCounts, {stiffness, damper})[7]; };
  EXPECT_EQ(row(1.0).low, range.low);
  EXPECT_NEAR(row(0.5 * range.low).margin, 0.5, 1e-9);
  EXPECT_GT(row(0.5 * (range.low + range.high)).margin, 1.0);
  EXPECT_NEAR(row(2.0 * range.high).margin, 0.5, 1e-9);
}

TEST(Bounds, FrictionRowsApplyWhereCountsDoNotPushMore) {
  const auto applies = [](const Steps& steps, double stiffness) {
    const auto rows = bounds(kPhantom, steps, {stiffness, {}});
    EXPECT_EQ(rows[4].applies, rows[5].applies);
    return rows[4].applies;
  };
  EXPECT_TRUE(applies(kCounts, 1000.0));
  EXPECT_FALSE(applies(kCounts, 4000.0));
  EXPECT_TRUE(applies({0.048, 0.0}, 4000.0));
}

TEST(Bounds, FrictionStopsSmallSwingsByItsEquivalentDamping) {
  // A swing of amplitude A grows by sampling as b < K T/2 and is stopped as 4 f_c/(pi w A) makes up for it.
  const double k = friction_stiffness(kPhantom, 0.048, {}, 1e-3);
  const double w = std::sqrt(k / 0.075), more = 4.0 * 0.048 / (M_PI * w * 1e-3);
  EXPECT_NEAR(k, 2.0 * (0.0114 + more) / 1e-3, 0.03 * k);
  EXPECT_GT(k, 900.0);
  EXPECT_LT(k, 1300.0);
  EXPECT_NEAR(friction_stiffness(kPhantom, 0.0, {}, 1e-3), critical_stiffness(kPhantom), 0.01);
  EXPECT_GT(friction_stiffness(kPhantom, 0.048, {}, 1e-4), 3.0 * k);
}

TEST(Bounds, RowsSayWhatTheyAre) {
  SampledLoop loop = wall(0.2, 1e-3);
  loop.hand = {0.1, 4.0, 300.0};
  const auto rows = bounds(loop, kCounts, {200.0, {}});
  ASSERT_EQ(rows.size(), 8U);
  for (const Row& row : rows) {
    EXPECT_FALSE(row.name.empty() || row.formula.empty() || row.source.empty());
    EXPECT_NEAR(row.margin, row.bound / 200.0, 1e-9) << row.name;
  }
  EXPECT_EQ(rows[1].name, "abbott_okamura");
  EXPECT_FALSE(rows[1].applies);  // of a loop with delay
  EXPECT_TRUE(rows[2].applies);
  EXPECT_FALSE(bounds(loop, kCounts, {200.0, {1.0, 0.0}})[2].applies);  // B above b
  EXPECT_GT(rows[7].bound, rows[6].bound);
}

}  // namespace
}  // namespace enc::certificate
