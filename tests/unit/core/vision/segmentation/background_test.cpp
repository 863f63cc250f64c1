// Mean and noise of the background's frames.
#include "core/vision/segmentation/background.h"

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace enc::segmentation {
namespace {

TEST(Background, IsTheMeanRoundedToTheNearest) {
  Background background({2, 1, 5});
  for (const std::uint8_t value : {10, 11, 11, 255}) {
    Image image(2, 1);
    image.rgb = {value, 255, 0, 7, 7, static_cast<std::uint8_t>(value / 2)};
    background.add(image.view());
  }
  EXPECT_EQ(background.frames(), 4);
  EXPECT_EQ(background.mean().rgb, (std::vector<std::uint8_t>{72, 255, 0, 7, 7, 36}));  // 71.75; 35.5
}

TEST(Background, HoldsAsManyBrightFramesAsItMay) {
  Background background({1, 1, 5});
  Image image(1, 1);
  image.rgb = {255, 255, 254};
  for (int i = 0; i < 255; ++i) background.add(image.view());
  EXPECT_EQ(background.mean().rgb, image.rgb);
  EXPECT_EQ(background.noise().front(), Background::kLeastNoise);
}

TEST(Background, KnowsTheNoiseOfEachTile) {
  std::mt19937 random(1);
  std::normal_distribution<double> gauss;
  Background background({23, 10, 5});
  for (int i = 0; i < 10; ++i) {
    Image image(23, 10);
    for (int y = 0; y < 10; ++y)
      for (int x = 0; x < 23; ++x)
        for (int c = 0; c < 3; ++c)
          image.at(x, y)[c] =
              static_cast<std::uint8_t>(std::lround(90.0 + 5.0 * x + (y < 5 ? 2.0 : 6.0) * gauss(random)));
    background.add(image.view());
  }
  const std::vector<double> noise = background.noise();
  ASSERT_EQ(noise.size(), 10U);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_NEAR(noise[i] / (i < 5 ? 2.0 : 6.0), 1.0, 0.12) << i;
}

}  // namespace
}  // namespace enc::segmentation
