// Noise of a sensor: as much as was asked, the same for the same frame, cut at 0 and 255.
#include "sim/camera/sensor.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/frames.h"

namespace enc::sim {
namespace {

Image grey(std::uint8_t value) {
  Image image(320, 240);
  std::fill(image.rgb.begin(), image.rgb.end(), value);
  return image;
}

TEST(SensorNoise, RmsAndMeanAreThoseAsked) {
  for (const double rms : {0.2, 0.7, 1.5, 4.0}) {
    const SensorNoise noise(rms, 7);
    double sum = 0.0, squares = 0.0, neighbours = 0.0;
    double count = 0.0;
    for (std::uint64_t frame = 0; frame < 10; ++frame) {
      Image image = grey(128);
      noise.add(image, frame, 0);
      for (std::size_t i = 0; i < image.rgb.size(); ++i, ++count) {
        const double d = image.rgb[i] - 128.0;
        sum += d;
        squares += d * d;
        if (i > 0) neighbours += d * (image.rgb[i - 1] - 128.0);
      }
    }
    EXPECT_NEAR(std::sqrt(squares / count), rms, 0.01 * rms);
    EXPECT_NEAR(sum / count, 0.0, 0.01 * rms);
    EXPECT_NEAR(neighbours / squares, 0.0, 0.01);
  }
}

TEST(SensorNoise, TheSameForTheSameFrameAndEye) {
  const SensorNoise noise(1.5, 7), again(1.5, 7), other(1.5, 8);
  const auto bits = [](const SensorNoise& n, std::uint64_t frame, std::uint64_t eye) {
    Image image = grey(100);
    n.add(image, frame, eye);
    return image.rgb;
  };
  EXPECT_EQ(bits(noise, 3, 1), bits(again, 3, 1));
  EXPECT_NE(bits(noise, 3, 1), bits(noise, 3, 0));
  EXPECT_NE(bits(noise, 3, 1), bits(noise, 4, 1));
  EXPECT_NE(bits(noise, 3, 1), bits(other, 3, 1));
  EXPECT_NE(bits(noise, 3, 1), bits(noise, 4, 0));
}

TEST(SensorNoise, IsCutWhereASensorEnds) {
  const SensorNoise noise(8.0, 1);
  Image dark = grey(0), bright = grey(255);
  noise.add(dark, 1, 0);
  noise.add(bright, 1, 0);
  for (const std::uint8_t v : dark.rgb) EXPECT_LT(v, 100);
  for (const std::uint8_t v : bright.rgb) EXPECT_GT(v, 155);
  Image still = grey(9);
  SensorNoise(0.0, 1).add(still, 1, 0);
  EXPECT_EQ(still.rgb, grey(9).rgb);
  EXPECT_THROW(SensorNoise(-1.0, 1), Error);
  EXPECT_THROW(SensorNoise(kUnset, 1), Error);
}

}  // namespace
}  // namespace enc::sim
