// A background that is completed over time.
#include "core/vision/augment/clean_background.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace enc::augment {
namespace {

Image grey(std::uint8_t level) {
  Image image(8, 4);
  std::fill(image.rgb.begin(), image.rgb.end(), level);
  return image;
}

Mask column(int x) {
  Mask mask(8, 4);
  for (int y = 0; x >= 0 && y < 4; ++y) mask.row(y)[x] = 255;
  return mask;
}

TEST(CleanBackground, WhatIsCoveredIsLearnedWhenItIsUncovered) {
  CleanBackground background(8, 4, 3);
  for (const int level : {99, 100, 102})
    background.add(grey(static_cast<std::uint8_t>(level)).view(), column(5));
  EXPECT_FALSE(background.known().at(5, 2));
  EXPECT_TRUE(background.known().at(4, 2));
  EXPECT_EQ(background.image().view().at(4, 2)[0], 100);  // (99 + 100 + 102) / 3
  for (int i = 0; i < 3; ++i) background.add(grey(60).view(), column(-1));
  EXPECT_TRUE(background.known().at(5, 2));
  EXPECT_EQ(background.image().view().at(5, 2)[1], 60);
  EXPECT_EQ(background.image().view().at(4, 2)[1], 100);  // once learned it stays
}

TEST(CleanBackground, WhatMovesDoesNotGetIn) {
  CleanBackground background(8, 4, 3);
  for (const int level : {50, 50, 200, 50, 50}) {
    background.add(grey(static_cast<std::uint8_t>(level)).view(), column(-1));
    EXPECT_FALSE(background.known().at(0, 0));
  }
  background.add(grey(50).view(), column(-1));
  EXPECT_TRUE(background.known().at(0, 0));
  EXPECT_EQ(background.image().view().at(0, 0)[2], 50);
}

// Between 10 and 40, three pixels apart: nearer to the 10, weights 1 : 1/4 along the row; the column is
// unknown.
TEST(CleanBackground, AGapGoesOnFromItsSides) {
  CleanBackground background(8, 4, 1);
  Image image = grey(10);
  Mask gap = column(3);
  for (int y = 0; y < 4; ++y) {
    gap.row(y)[4] = 255;
    std::fill_n(image.at(5, y), 9, std::uint8_t{40});
  }
  background.add(image.view(), gap);
  EXPECT_EQ(background.image().view().at(3, 1)[0], 16);
  EXPECT_EQ(background.image().view().at(4, 1)[0], 34);
  EXPECT_FALSE(background.known().at(3, 1));
}

}  // namespace
}  // namespace enc::augment
