// What the light of a frame is said to be: gains, a lamp at the side, what is left over; half hidden by a
// hand.
#include "core/vision/segmentation/light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

namespace enc::segmentation {
namespace {

constexpr int kWidth = 320, kHeight = 240;

// Tiles of many colours; `light` gives the gains at a share of the width.
template <class F>
Image frame(const F& light, double hidden = 0.0) {
  Image image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double u = static_cast<double>(x) / kWidth;
      const bool hand = (y * 7 / 10 + x * 3 / 10) < hidden * 240.0;
      for (int c = 0; c < 3; ++c) {
        const double colour = hand ? 200.0 - 40.0 * c : 60.0 + (x / 20 * 37 + y / 20 * 53 + c * 41) % 90;
        image.at(x, y)[c] = static_cast<std::uint8_t>(
            std::lround(std::min(255.0, colour * light(u)[static_cast<std::size_t>(c)])));
      }
    }
  return image;
}
std::array<double, 3> steady(double) { return {1.0, 1.0, 1.0}; }

Light measured(const Image& image) {
  return LightMeter(frame(steady), {kWidth, kHeight, 5}).measure(image.view());
}

TEST(Light, OfTheBackgroundIsOne) {
  const Light light = measured(frame(steady));
  for (const double gain : light.gain) EXPECT_NEAR(gain, 1.0, 0.001);
  EXPECT_NEAR(light.across, 0.0, 0.001);
  EXPECT_LT(light.bright, 0.001);
  EXPECT_LT(light.colour, 0.001);
}

TEST(Light, HasItsColourAndItsSide) {
  for (const double hidden : {0.0, 0.35}) {
    const Light light = measured(frame(
        [](double u) {
          return std::array{0.9 * (0.7 + 0.5 * u), 0.7 + 0.5 * u, 1.1 * (0.7 + 0.5 * u)};
        },
        hidden));
    EXPECT_NEAR(light.gain[0] / light.gain[1], 0.9, 0.01) << hidden;
    EXPECT_NEAR(light.gain[2] / light.gain[1], 1.1, 0.01) << hidden;
    EXPECT_NEAR(light.middle * light.gain[1], 0.95, 0.02) << hidden;
    EXPECT_NEAR(light.across * light.gain[1], 0.5, 0.02) << hidden;
    EXPECT_NEAR(light.down, 0.0, 0.02) << hidden;
    EXPECT_LT(light.bright, 0.02);
  }
}

TEST(Light, OfTooFewSamplesIsOne) {
  const Image black(kWidth, kHeight), image = frame(steady);
  const Light light = LightMeter(black, {kWidth, kHeight, 5}).measure(image.view());
  EXPECT_EQ(light.gain, (std::array{1.0, 1.0, 1.0}));
  EXPECT_EQ(light.middle, 1.0);
  const Light clipped = measured(frame([](double) { return std::array{9.0, 9.0, 9.0}; }));
  EXPECT_EQ(clipped.gain, (std::array{1.0, 1.0, 1.0}));
}

// Most of the background is clipped, a shaded hand before it is not: it says nothing of the light.
TEST(Light, OfAHandAloneIsOne) {
  Image image = frame([](double) { return std::array{3.0, 3.0, 3.0}; });
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth - y; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = static_cast<std::uint8_t>((60 + x / 3) * (5 - c) / 5);
  const Light light = measured(image);
  EXPECT_EQ(light.gain, (std::array{1.0, 1.0, 1.0}));
  EXPECT_EQ(light.bright, 0.0);
  EXPECT_EQ(light.middle, 1.0);
}

}  // namespace
}  // namespace enc::segmentation
