#include "hw_drivers/v4l2/drive/pairs.h"

#include <gtest/gtest.h>

namespace enc::v4l2 {
namespace {

Shot at(double ms, std::size_t slot = 0) { return {from_seconds(1e-3 * ms), slot}; }

TEST(V4l2Pairs, ALeftFrameWaitsForANearerRightOne) {
  Pairs pairs(from_seconds(0.050), from_seconds(0.0255));
  ShotPair pair;
  pairs.add_right(at(70));
  pairs.add_left(at(100));
  EXPECT_FALSE(pairs.next(pair));  // 30 ms apart; the next right frame is nearer
  pairs.add_right(at(120, 1));
  ASSERT_TRUE(pairs.next(pair));
  EXPECT_EQ(pair.right.slot, 1U);
  EXPECT_NEAR(seconds(pair.stamp()), 0.110, 1e-9);
  EXPECT_NEAR(pairs.errors().last, 0.020, 1e-9);
  EXPECT_FALSE(pairs.next(pair));  // once only
}

TEST(V4l2Pairs, ALeftFrameWithoutAPartnerIsDropped) {
  Pairs pairs(from_seconds(0.050), from_seconds(0.0255));
  ShotPair pair;
  for (const double ms : {100.0, 150.0, 200.0, 250.0}) pairs.add_left(at(ms));
  EXPECT_EQ(pairs.unpaired(), 1);  // three are held
  pairs.add_right(at(205));
  ASSERT_TRUE(pairs.next(pair));
  EXPECT_NEAR(seconds(pair.left.stamp), 0.200, 1e-9);
  EXPECT_EQ(pairs.unpaired(), 2);  // 150; the newest one still waits
  pairs.add_right(at(310));
  EXPECT_FALSE(pairs.next(pair));
  EXPECT_EQ(pairs.unpaired(), 3);
  EXPECT_EQ(pairs.errors().pairs, 1);
}

// At the border of half a period the nearer of two neighbours is taken, even if both are a little farther.
TEST(V4l2Pairs, AtTheBorderTheNearerOneIsTaken) {
  Pairs pairs(from_seconds(0.050), from_seconds(0.0255));
  ShotPair pair;
  pairs.add_right(at(74.8, 1));
  pairs.add_left(at(100));
  EXPECT_FALSE(pairs.next(pair));
  pairs.add_right(at(124.9, 2));
  ASSERT_TRUE(pairs.next(pair));
  EXPECT_EQ(pair.right.slot, 2U);
  pairs.add_left(at(150.2));
  pairs.add_right(at(175.5));
  ASSERT_TRUE(pairs.next(pair));
  EXPECT_NEAR(pairs.errors().last, 0.0253, 1e-9);
  EXPECT_EQ(pairs.unpaired(), 0);
}

TEST(V4l2Pairs, FramesFromBeforeAreForgotten) {
  Pairs pairs(from_seconds(0.050), from_seconds(0.0255));
  ShotPair pair;
  pairs.add_left(at(100));
  pairs.forget();
  pairs.add_right(at(100));
  EXPECT_FALSE(pairs.next(pair));
}

}  // namespace
}  // namespace enc::v4l2
