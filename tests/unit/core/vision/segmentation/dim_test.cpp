// Skin too dim for a hue of its own: found by its surroundings; grey, a bright wall in shadow, a lone pixel
// and another hue are not.
#include "core/vision/segmentation/dim.h"

#include <algorithm>
#include <array>
#include <random>

#include <gtest/gtest.h>

#include "core/vision/segmentation/kernels/arc.h"

namespace enc::segmentation {
namespace {

constexpr int kSide = 60;
constexpr std::uint16_t kWhite[3] = {256, 256, 256};

// Share of a dim square that is found, of one colour and 1.5 of noise. Skin is 10 to 30 degrees of hue.
double found(const std::array<double, 3>& colour, const std::uint16_t (&white)[3] = kWhite, int apart = 1) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 1.5);
  Image image(kSide, kSide);
  for (std::size_t i = 0; i < image.rgb.size(); ++i)
    image.rgb[i] =
        static_cast<std::uint8_t>(std::clamp(std::round(colour[i % 3] + noise(random)), 0.0, 255.0));
  Mask dim(kSide, kSide), skin(kSide, kSide);
  int dims = 0;
  for (int y = 0; y < kSide; y += apart)
    for (int x = 0; x < kSide; x += apart) {
      dim.row(y)[x] = 255;
      ++dims;
    }
  find_dim(image.view(), dim, dim.whole(), white, cut_of({43, 85}, HueRule{}), skin);
  return static_cast<double>(std::count(skin.on.begin(), skin.on.end(), 255)) / dims;
}

TEST(Dim, SkinIsFoundByItsSurroundings) {
  EXPECT_GT(found({13, 9.5, 7.5}),
            0.95);  // a chroma of 5.5, 20 degrees: 2.5 spreads of its noise from the ends
  EXPECT_LT(found({13, 9.5, 7.5}, kWhite, 5), 0.1);  // the same without any
}

TEST(Dim, WhatIsNotSkinIsNotFound) {
  EXPECT_LT(found({9, 9, 9}), 0.001);
  EXPECT_LT(found({7.5, 13, 9.5}), 0.001);   // green
  EXPECT_LT(found({200, 195, 192}), 0.001);  // a chroma of 8, 22 degrees: a beige wall in shadow
  EXPECT_LT(found({2.5, 1.9, 1.5}), 0.02);   // darker than black's own noise
}

TEST(Dim, InTheLightOfTheBackground) {
  const std::uint16_t bluish[3] = {256, 256, 128};  // what takes a blue lamp's colour away
  EXPECT_LT(found({13, 8.5, 13}), 0.01);
  EXPECT_GT(found({13, 8.5, 13}, bluish), 0.95);
}

TEST(Dim, OnlyWithinTheRegion) {
  Image image(9, 9);
  for (std::size_t i = 0; i < image.rgb.size(); ++i)
    image.rgb[i] = static_cast<std::uint8_t>(std::array{14, 10, 8}[i % 3]);
  Mask dim(9, 9), skin(9, 9);
  std::fill(dim.on.begin(), dim.on.end(), std::uint8_t{255});
  find_dim(image.view(), dim, {2, 3, 5, 6}, kWhite, cut_of({43, 85}, HueRule{}), skin);
  EXPECT_EQ(std::count(skin.on.begin(), skin.on.end(), 255), 9);
  EXPECT_TRUE(skin.at(2, 3) && skin.at(4, 5));
}

}  // namespace
}  // namespace enc::segmentation
