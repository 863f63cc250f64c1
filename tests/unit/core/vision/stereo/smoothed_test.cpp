#include "core/vision/stereo/smoothed.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sim/truth/random.h"

namespace enc {
namespace {

constexpr int kColumns = 40, kRows = 30;

Grey noise() {
  Grey image(kColumns, kRows);
  sim::Stream stream(1, "smoothed");
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) *image.at(x, y) = static_cast<std::uint8_t>(stream.bits());
  return image;
}
const Region kWhole{0, 0, kColumns, kRows};

TEST(Smoothed, WithoutAPassItIsTheImage) {
  const Grey image = noise();
  const Smoothed same(image, kWhole, 0);
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) ASSERT_EQ(*same.at(x, y), static_cast<float>(*image.at(x, y)));
}

TEST(Smoothed, APointSpreadsByHalfAPixelSquaredAPass) {
  Grey image(kColumns, kRows);
  *image.at(20, 15) = 200;
  for (const int passes : {1, 2, 5}) {
    const Smoothed spread(image, kWhole, passes);
    double sum = 0.0, across = 0.0, down = 0.0;
    for (int y = 0; y < kRows; ++y)
      for (int x = 0; x < kColumns; ++x) {
        const auto level = static_cast<double>(*spread.at(x, y));
        sum += level;
        across += level * (x - 20) * (x - 20);
        down += level * (y - 15) * (y - 15);
      }
    EXPECT_NEAR(sum, 200.0, 1e-3);
    EXPECT_NEAR(across / sum, 0.5 * passes, 1e-5);
    EXPECT_NEAR(down / sum, 0.5 * passes, 1e-5);
  }
}

TEST(Smoothed, APixelIsTheSameWhateverElseIsAsked) {
  const Grey image = noise();
  const Smoothed all(image, kWhole, 3);
  for (const Region& part : {Region{10, 8, 20, 14}, Region{-5, -5, 4, 3}, Region{35, 20, 60, 50}}) {
    const Smoothed some(image, part, 3);
    EXPECT_EQ(some.part(), part.cut(kWhole));
    for (int y = some.part().y0; y < some.part().y1; ++y)
      for (int x = some.part().x0; x < some.part().x1; ++x) ASSERT_EQ(*some.at(x, y), *all.at(x, y));
  }
  EXPECT_TRUE(Smoothed(image, Region{50, 0, 60, 10}, 3).part().empty());
}

}  // namespace
}  // namespace enc
