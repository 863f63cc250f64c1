// Drawn balls under the sensor's noise: their numbers are inside of the intervals as often as these say.
#include <algorithm>

#include <gtest/gtest.h>

#include "sim/truth/random.h"
#include "tests/support/ball_pushes.h"
#include "trial/identify/ball/ball_fit.h"

namespace enc::bench {
namespace {

TEST(BallFitProperty, IntervalsHoldWhatWasInjected) {
  constexpr int kTrials = 20;
  int inside = 0;
  double widest = 0.0;
  for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
    sim::Stream random(seed, "ball_fit");
    trial::StandingBall truth;
    for (std::size_t i = 0; i < trial::kNearer; ++i)
      trial::ball_numbers()[i].of(truth) *= 0.8 + 0.4 * random.uniform();
    trial::Pushes pushes = test::ball_pushes(truth.law, {20e-3, 6e-3, 2.0});
    test::add_noise(pushes, seed);
    for (const trial::BallEstimate& e : trial::fit_ball(trial::BallLoops({pushes})).estimates) {
      inside += e.interval.holds(trial::value_of(trial::ball_numbers()[e.number], truth)) ? 1 : 0;
      if (e.number == trial::kRubberModulus) widest = std::max(widest, e.width());
    }
  }
  // Of 180, 171 are expected; the errors of one ball's numbers go together, so half as many count: 5 and 4
  // more or less.
  EXPECT_GE(inside, 160);
  EXPECT_LE(widest, 0.05);
}

}  // namespace
}  // namespace enc::bench
