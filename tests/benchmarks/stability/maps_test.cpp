// Places that are drawn for spot checks, and who holds a device.
#include "benchmarks/stability/maps.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace enc::bench::stability {
namespace {

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
  EXPECT_EQ(all.size(), 17U);
  EXPECT_NEAR(all.front(), 1e-2, 1e-9);
  EXPECT_NEAR(all.back(), 1e6, 1.0);
}

}  // namespace
}  // namespace enc::bench::stability
