// One look at a pair: what is foreseen of the depth changes the work, never the result.
#include "core/vision/hand/hand_scene.h"

#include <gtest/gtest.h>

#include "core/vision/stereo/triangulate.h"
#include "tests/unit/core/vision/finger/drawn_hand.h"

namespace enc {
namespace {

using drawn::small;

TEST(HandScene, AFingerNearerThanForeseenIsSeenAsWell) {
  drawn::HandAt hand;
  hand.tip = {0.06, 0.01, 0.40};
  const drawn::Pair room = drawn::pair_of(small(), nullptr, 9), pair = drawn::pair_of(small(), &hand);
  const auto look = [&](bool all, double expected) {
    HandScene scene(small(), drawn::segmentation(), {}, {});
    while (!scene.learned()) scene.learn(room.frame());
    const Triplet at = seen_at(scene.pair(), Point<'C'>(hand.tip));
    const int x = static_cast<int>(at.column), y = static_cast<int>(at.row);
    return scene.look(pair.frame(), all ? scene.frame() : Region{x - 7, y - 4, x + 8, y + 13},
                      {.at = {at.column, at.row, expected}});
  };
  for (const double expected : {kUnset, 70.0, 81.0, 90.0}) {
    const HandScene::Seen whole = look(true, expected);
    ASSERT_TRUE(whole.tip.found && whole.tip.fitted);
    EXPECT_NEAR(whole.disparity, 81.0, 0.3);
    const HandScene::Seen seen = look(false, expected);
    ASSERT_TRUE(seen.tip.found) << expected;
    EXPECT_EQ(seen.tip.column, whole.tip.column) << expected;
    EXPECT_EQ(seen.tip.row, whole.tip.row) << expected;
    EXPECT_EQ(seen.disparity, whole.disparity) << expected;
    EXPECT_EQ(seen.variance, whole.variance) << expected;
    EXPECT_LT(seen.pixels, whole.pixels);
  }
}

}  // namespace
}  // namespace enc
