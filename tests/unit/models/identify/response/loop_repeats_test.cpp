// What repeats alone say about a force at a deflection: Student's interval of their mean.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "models/identify/response/loop_fit.h"

namespace enc::models {
namespace {

// Presses of one line, 2 N/mm up and 1.9 N/mm back; each as a whole higher by `shifts`, N.
LoopData presses(const std::vector<double>& shifts) {
  LoopData loop;
  for (const double shift : shifts) {
    loop.moving.emplace_back();
    for (int i = 1; i < 1200; ++i) {
      const double d = 1e-5 * std::min(i, 1200 - i);
      loop.moving.back().push_back({d, (i <= 600 ? 2000.0 : 1900.0) * d + shift, i <= 600});
    }
    loop.presses.push_back(loop.moving.back());
  }
  return loop;
}

// Three presses at -0.01, 0 and 0.01 N: their standard deviation is 0.01 N, Student's t of 2 is 4.30, so the
// mean is known to 4.30 * 0.01 / sqrt(3) = 0.0248 N. (t comes from a series, some per cent off at 2.)
TEST(LoopRepeats, IntervalOfTheMeanAsByHand) {
  const LoopFit fit = fit_loop(presses({-0.01, 0.0, 0.01}), {6e-3, 100.0, 1e5});
  for (const BranchKnown* branch : {&fit.press, &fit.release}) {
    ASSERT_EQ(branch->repeats.size(), 6U);
    for (const double half : branch->repeats) EXPECT_NEAR(half, 0.0248, 0.003);
  }
}

TEST(LoopRepeats, TwoSayNothing) {
  for (const double half : fit_loop(presses({0.0, 0.01}), {6e-3, 100.0, 1e5}).press.repeats)
    EXPECT_TRUE(std::isnan(half));
}

}  // namespace
}  // namespace enc::models
