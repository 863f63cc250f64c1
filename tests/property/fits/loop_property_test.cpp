// `fit` on loops of one law, as rigs record them: at any speeds, holds, rates and zeros the curves are those
// of the law, and inside of their intervals as often as these say.
#include <array>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "models/identify/response/loop_fit.h"
#include "tests/support/built.h"
#include "tests/support/plant_loop.h"

namespace enc {
namespace {

using models::LoopData;
using models::LoopFit;
using test::LawLoop;

constexpr double kLimit = 6e-3, kFloor = 124.95;  // m, N/m
constexpr double kNear = 0.02;                    // N

struct Fitted {
  LoopData loop;
  LoopFit fit;
};
Fitted fitted(const LawLoop& made, std::uint64_t seed) {
  Fitted all;
  all.loop = models::parse_loop(test::law_loop_csv(made, seed), "law.csv", kLimit);
  all.fit = models::fit_loop(all.loop, {kLimit, kFloor, kUnset});
  return all;
}

void expect_law(const LoopFit& fit, double near = kNear) {
  EXPECT_NEAR(fit.press.curve.back().value, test::law_force(6.0, true), near);
  EXPECT_NEAR(fit.release.curve.back().value, test::law_force(6.0, false), near);
  EXPECT_NEAR(fit.press.curve.front().value, test::law_force(1.0, true), near);
  EXPECT_NEAR(fit.release.curve.front().value, test::law_force(1.0, false), near);
  for (const models::BranchKnown* branch : {&fit.press, &fit.release})
    for (const models::Known& k : branch->curve) {
      EXPECT_GT(k.half, 0.0);
      EXPECT_LT(k.half, 0.1);
    }
}

TEST(LoopProperty, NeitherSpeedsNorHoldsMoveTheCurves) {
  for (const double ratio : {0.1, 0.5, 1.0, 3.0, 10.0, 20.0})
    for (const double hold : {0.0, 0.05, 1.0, 30.0}) {
      if (hold == 30.0 && ratio != 1.0 && tests::thorough(0, 1) == 0) continue;
      LawLoop made;
      made.out_mm_s = ratio * made.in_mm_s;
      made.hold_s = hold;
      made.relaxes = 0.1;
      made.repeats = ratio < 1.0 ? 2 : 5;
      for (int seed = 1; seed <= tests::thorough(1, 5); ++seed) {
        SCOPED_TRACE(testing::Message() << ratio << " times as fast out, " << hold << " s, seed " << seed);
        const Fitted all = fitted(made, static_cast<std::uint64_t>(seed));
        expect_law(all.fit);
        EXPECT_TRUE(all.loop.notes.empty()) << all.loop.notes.front();
      }
    }
}

// How often the law lies inside of the interval, at 1 to 6 mm of either branch.
struct Inside {
  int draws = 0;
  std::array<std::array<int, 6>, 2> held{};
};
Inside count(const LawLoop& made, int draws) {
  Inside inside;
  for (; inside.draws < draws; ++inside.draws) {
    const LoopFit fit = fitted(made, static_cast<std::uint64_t>(inside.draws) + 1).fit;
    for (const bool pressing : {true, false}) {
      const auto& curve = (pressing ? fit.press : fit.release).curve;
      for (std::size_t i = 0; i < curve.size(); ++i)
        inside.held[pressing ? 0 : 1][i] +=
            std::abs(curve[i].value - test::law_force(static_cast<double>(i + 1), pressing)) <= curve[i].half;
    }
  }
  return inside;
}
void expect_inside(const LawLoop& made, const char* what) {
  SCOPED_TRACE(what);
  const Inside inside = count(made, tests::thorough(10, 100));
  for (const auto& branch : inside.held)
    for (std::size_t i = 0; i < branch.size(); ++i)
      EXPECT_GE(branch[i], 9 * inside.draws / 10)
          << (&branch == inside.held.data() ? "pressing " : "releasing ") << i + 1 << " mm";
}

TEST(LoopProperty, IntervalsHoldTheLaw) {
  expect_inside({}, "at 4 mm/s");
  expect_inside({.out_mm_s = 40.0}, "out at 40 mm/s");
  expect_inside({.hold_s = 1.0, .relaxes = 0.1, .rate_Hz = 200.0}, "at 200 Hz, with a hold");
  expect_inside({.repeats = 1}, "one press");
  expect_inside({.zero_N = 0.6, .zero_drift_N = 0.05, .marks_all = true}, "with a zero that drifts");
  expect_inside({.begin_mm = 2.0, .marks_all = true}, "with contact that begins at 2 mm");
}

// Before contact the force is not 0, contact does not begin at 0, or both.
TEST(LoopProperty, ZeroAndBeginArePutRight) {
  for (const double zero : {-0.3, 0.0, 0.6})
    for (const double begin : {-0.5, 0.0, 0.1, 2.0})
      for (const double drift : {0.0, 0.1})
        for (const bool marks_all : {true, false}) {
          if (marks_all == (drift != 0.0) && tests::thorough(0, 1) == 0) continue;
          SCOPED_TRACE(testing::Message() << zero << " N, " << drift << " N more each time, " << begin
                                          << " mm, " << (marks_all ? "all rows marked" : "contact marked"));
          LawLoop made;
          made.zero_N = zero;
          made.zero_drift_N = drift;
          made.begin_mm = begin;
          made.marks_all = marks_all;
          const Fitted all = fitted(made, 1);
          expect_law(all.fit);
          EXPECT_EQ(all.loop.notes.size(),
                    (zero != 0.0 || drift != 0.0 ? 1U : 0U) + (begin != 0.0 ? 1U : 0U));
        }
}

// Coarse rates, noisy positions, an overshoot before the hold, a rest near contact.
TEST(LoopProperty, RatesAndNoiseOnlyWidenTheIntervals) {
  const std::vector<LawLoop> all{{.rate_Hz = 100.0},
                                 {.hold_s = 5.0, .rate_Hz = 60.0},
                                 {.hold_s = 5.0, .deflection_noise_mm = 0.0, .force_noise_N = 0.0},
                                 {.hold_s = 3.0, .deflection_noise_mm = 0.02},
                                 {.hold_s = 10.0, .relaxes = 0.2, .overshoot_mm = 0.05},
                                 {.force_noise_N = 0.1},
                                 {.clear_mm = 0.5, .repeats = 3},
                                 {.clear_mm = 10.0}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    SCOPED_TRACE(i);
    const LoopFit fit = fitted(all[i], 1).fit;
    EXPECT_NEAR(fit.press.curve.back().value, test::law_force(6.0, true),
                kNear + fit.press.curve.back().half);
    EXPECT_NEAR(fit.release.curve.back().value, test::law_force(6.0, false),
                kNear + fit.release.curve.back().half);
    EXPECT_LT(fit.press.curve.back().half, 0.15);
    EXPECT_LT(fit.release.curve.back().half, 0.15);
  }
}

}  // namespace
}  // namespace enc
