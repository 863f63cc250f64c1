// Left and right exchanged are noticed in the first frame that shows enough, and never otherwise.
#include "core/vision/finger/exchanged.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/unit/core/vision/finger/drawn_hand.h"

namespace enc {
namespace {

Grey grey_of(const Image& image) {
  Grey grey(image.width, image.height);
  to_grey(image.view(), {0, 0, image.width, image.height}, grey);
  return grey;
}

class ExchangedTest : public testing::Test {
 protected:
  StereoRig rig = drawn::small();
  Exchanged watch{Rectifier(rig).pair(), 320, 240};
  static Grey bare() {
    Grey grey(320, 240);
    std::fill(grey.level.begin(), grey.level.end(), std::uint8_t{90});
    return grey;
  }
};

TEST_F(ExchangedTest, IsSeenAtOnceAndEndsAtOnce) {
  drawn::HandAt hand;
  hand.tip = {0.0, 0.0, 0.45};
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const drawn::Pair pair = drawn::pair_of(rig, &hand, seed);
    const Grey left = grey_of(pair.left), right = grey_of(pair.right);
    EXPECT_FALSE(watch.see(left, right)) << seed;
    EXPECT_TRUE(watch.see(right, left)) << seed;
    EXPECT_FALSE(watch.see(left, right)) << seed;
  }
}

TEST_F(ExchangedTest, WhatShowsNothingChangesNothing) {
  const drawn::Pair pair = drawn::pair_of(rig, nullptr);
  const Grey left = grey_of(pair.left), right = grey_of(pair.right);
  EXPECT_FALSE(watch.see(bare(), bare()));
  EXPECT_TRUE(watch.see(right, left));
  EXPECT_TRUE(watch.see(bare(), bare()));
}

// Two images that have nothing to do with each other are neither.
TEST_F(ExchangedTest, NoiseIsNoSign) {
  const auto noisy = [](std::uint64_t seed) {
    Grey grey(320, 240);
    for (int y = 0; y < 240; ++y)
      for (int x = 0; x < 320; ++x)
        *grey.at(x, y) =
            static_cast<std::uint8_t>(255.0 * drawn::hashed(x, y, static_cast<std::int64_t>(seed)));
    return grey;
  };
  for (std::uint64_t seed = 0; seed < 20; ++seed) EXPECT_FALSE(watch.see(noisy(seed), noisy(seed + 100)));
}

// A pair of cameras far apart, or of few pixels, is none that it refuses.
TEST_F(ExchangedTest, AnyRigIsLookedAt) {
  RectifiedPair wide = Rectifier(rig).pair();
  wide.baseline = 1.0;
  EXPECT_NO_THROW(Exchanged(wide, 320, 240));
  Exchanged tiny(Rectifier(rig).pair(), 8, 4);
  EXPECT_FALSE(tiny.see(Grey(8, 4), Grey(8, 4)));
}

}  // namespace
}  // namespace enc
