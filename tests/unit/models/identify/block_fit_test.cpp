#include "models/identify/block_fit.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sim/truth/random.h"

namespace enc::models {
namespace {

TEST(BlockFit, FindsALineAndHowWellItIsKnown) {
  int held = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    sim::Stream noise(seed, "block fit");
    BlockFit fit(2, 0.25);
    for (int i = 0; i < 8000; ++i) {
      const double t = 1e-3 * i;
      fit.add(t, Eigen::Vector2d(1.0, std::sin(t)), 0.5 - 3.0 * std::sin(t) + 0.1 * noise.normal3().x());
    }
    const BlockFit::Result found = fit.solve();
    EXPECT_NEAR(found.values[0].value, 0.5, 0.01);
    EXPECT_NEAR(found.values[1].value, -3.0, 0.01);
    EXPECT_NEAR(found.rms, 0.1, 0.005);
    held += found.values[1].holds(-3.0) ? 1 : 0;
  }
  EXPECT_GE(held, 182);  // of 190 that 95 % would be: three standard deviations of such a count
}

TEST(BlockFit, SaysNothingOfWhatItCannotTellApart) {
  BlockFit fit(4, 0.25);
  for (int i = 0; i < 1000; ++i) {
    const double x = std::cos(1e-2 * i);
    Eigen::VectorXd row(4);
    row << x, 2.0 * x, 0.0, 1.0;
    fit.add(1e-3 * i, row, 3.0 * x + 1.0);
  }
  const BlockFit::Result found = fit.solve();
  EXPECT_NEAR(found.values[0].value, 3.0, 1e-9);
  EXPECT_TRUE(std::isnan(found.values[1].value));  // the same as the first
  EXPECT_TRUE(std::isnan(found.values[2].value));  // not there
  EXPECT_NEAR(found.values[3].value, 1.0, 1e-9);
}

// Two blocks do not say how much blocks scatter: Student's t of one degree of freedom is 12.7.
TEST(BlockFit, OfTwoBlocksThereIsNoInterval) {
  for (const int blocks : {1, 2, 3, 4}) {
    sim::Stream noise(1, "block fit");
    BlockFit fit(1, 0.25);
    for (int i = 0; i < 250 * blocks; ++i)
      fit.add(1e-3 * i, Eigen::VectorXd::Ones(1), 2.0 + 0.1 * noise.normal3().x());
    const Interval mean = fit.solve().values[0];
    EXPECT_NEAR(mean.value, 2.0, 0.05);
    EXPECT_EQ(mean.known(), blocks > 2) << blocks;
  }
}

TEST(BlockFit, OfNothingKnowsNothing) {
  const BlockFit::Result found = BlockFit(1, 0.25).solve();
  EXPECT_TRUE(std::isnan(found.values[0].value));
  EXPECT_TRUE(std::isnan(found.rms));
}

}  // namespace
}  // namespace enc::models
