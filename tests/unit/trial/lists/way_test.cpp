// For how long a prop has been where it is wanted, also after more ticks than are kept.
#include "trial/lists/way.h"

#include <gtest/gtest.h>

namespace enc::trial {
namespace {

constexpr double kWithin = 2e-3;  // m

TEST(Way, CountsTheLastTicksAtAPlace) {
  const Point<'W'> place(0.1, 0.2, 0.3), beside(0.1, 0.2, 0.31);
  Way way;
  EXPECT_EQ(way.there(place, kWithin), 0U);
  for (int i = 0; i < 5; ++i) way.add(place);
  way.add(beside);
  EXPECT_EQ(way.there(place, kWithin), 0U);
  EXPECT_EQ(way.there(beside, kWithin), 1U);
  for (int i = 0; i < 3; ++i) way.add(place);
  EXPECT_EQ(way.there(place, kWithin), 3U);
  way.clear();
  EXPECT_EQ(way.there(place, kWithin), 0U);
}

TEST(Way, KeepsTheLastTicksAlone) {
  const Point<'W'> place(0.1, 0.2, 0.3), beside(0.1, 0.2, 0.31);
  Way way;
  for (std::size_t i = 0; i < Way::kMost + 7; ++i) way.add(place);
  EXPECT_EQ(way.there(place, kWithin), Way::kMost);
  way.add(beside);
  for (int i = 0; i < 9; ++i) way.add(place);
  EXPECT_EQ(way.there(place, kWithin), 9U);
}

}  // namespace
}  // namespace enc::trial
