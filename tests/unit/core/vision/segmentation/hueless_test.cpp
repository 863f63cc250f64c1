// Skin too dim for a hue of its own: what its surroundings must have, how far they reach, that a background
// of skin's hue keeps its shadow, and what light's colour does.
#include "core/vision/segmentation/hueless.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/vision/segmentation/kernels/arc.h"

namespace enc::segmentation {
namespace {

constexpr int kSide = 40;
constexpr std::uint16_t kWhite[3] = {256, 256, 256};
using Colour = std::array<int, 3>;

class HuelessTest : public testing::Test {
 protected:
  HuelessTest() : hueless_(kSide, kSide) {
    for (auto* plane : {&background_.red, &background_.green, &background_.blue})
      plane->resize(std::size_t{kSide} * kSide);
    behind({150, 150, 150});
    std::fill(hueless_.on.begin(), hueless_.on.end(), std::uint8_t{255});
  }
  void paint(const Colour& colour, double noise = 0.0) {
    std::mt19937 random(5);
    std::normal_distribution<double> gauss(0.0, noise > 0.0 ? noise : 1.0);
    for (std::size_t i = 0; i < image_.rgb.size(); ++i)
      image_.rgb[i] = static_cast<std::uint8_t>(
          std::clamp(std::round(colour[i % 3] + (noise > 0.0 ? gauss(random) : 0.0)), 0.0, 255.0));
  }
  void behind(const Colour& colour) {
    std::fill(background_.red.begin(), background_.red.end(), static_cast<std::uint8_t>(colour[0]));
    std::fill(background_.green.begin(), background_.green.end(), static_cast<std::uint8_t>(colour[1]));
    std::fill(background_.blue.begin(), background_.blue.end(), static_cast<std::uint8_t>(colour[2]));
  }
  // Skin is 10 to 33 degrees of hue.
  Mask found(const Region& region = {0, 0, kSide, kSide}, const std::uint16_t (&white)[3] = kWhite) {
    Mask skin(kSide, kSide);
    Hueless hueless(kSide);
    for (int i = 0; i < 2; ++i)  // nothing is left of the time before
      hueless.find(image_.view(), background_, hueless_, region, white, cut_of({43, 100}, HueRule{}), skin);
    return skin;
  }
  static int count(const Mask& mask) {
    return static_cast<int>(std::count(mask.on.begin(), mask.on.end(), 255));
  }
  bool in_the_middle(const Colour& colour) {
    paint(colour);
    return found().at(kSide / 2, kSide / 2);
  }

  Image image_{kSide, kSide};
  Planes background_;
  Mask hueless_;
};

TEST_F(HuelessTest, TheSumHasTheChromaThatItsNoiseAsksFor) {
  EXPECT_TRUE(in_the_middle({9, 7, 6}));   // 25 times 3 is more than 5 times 12
  EXPECT_FALSE(in_the_middle({8, 7, 6}));  // 25 times 2 is not
}

TEST_F(HuelessTest, TheMeanHasAFloor) {
  EXPECT_TRUE(in_the_middle({8, 6, 5}));
  EXPECT_FALSE(in_the_middle({7, 5, 4}));
}

TEST_F(HuelessTest, ItIsMoreSaturatedThanAGreyWall) {
  EXPECT_TRUE(in_the_middle({12, 10, 9}));
  EXPECT_FALSE(in_the_middle({13, 11, 10}));
  EXPECT_FALSE(in_the_middle({200, 195, 192}));
}

TEST_F(HuelessTest, ItHasTheHueOfSkin) {
  EXPECT_TRUE(in_the_middle({15, 11, 9}));
  EXPECT_FALSE(in_the_middle({9, 15, 11}));
  EXPECT_FALSE(in_the_middle({9, 9, 9}));
}

TEST_F(HuelessTest, InTheLightOfTheBackground) {
  const std::uint16_t of_a_blue_lamp[3] = {256, 256, 128};
  paint({13, 9, 14});
  EXPECT_EQ(count(found()), 0);
  EXPECT_EQ(count(found({0, 0, kSide, kSide}, of_a_blue_lamp)), kSide * kSide);
}

TEST_F(HuelessTest, NoiseHidesLittle) {
  paint({13, 10, 8}, 1.5);
  EXPECT_GT(count(found()), 0.9 * kSide * kSide);
  paint({10, 10, 10}, 1.5);
  EXPECT_LT(count(found()), 0.005 * kSide * kSide);
}

// Brown, in a shadow.
TEST_F(HuelessTest, ABackgroundOfSkinsHueKeepsItsShadow) {
  paint({15, 11, 9});
  behind({60, 45, 38});
  EXPECT_EQ(count(found()), 0);
  behind({38, 45, 60});
  EXPECT_EQ(count(found()), kSide * kSide);
}

// Two pixels, neither of which is enough, 2 px apart and 3.
TEST_F(HuelessTest, SurroundingsReachTwoPixels) {
  paint({27, 20, 16});  // a chroma of 11
  for (const auto& [x, y] : {std::pair{22, 20}, {18, 20}, {20, 22}, {20, 18}, {22, 18}}) {
    std::fill(hueless_.on.begin(), hueless_.on.end(), std::uint8_t{0});
    hueless_.row(20)[20] = 255;
    EXPECT_EQ(count(found()), 0);
    hueless_.row(y)[x] = 255;
    EXPECT_EQ(count(found()), 2) << x << " " << y;
    hueless_.row(y)[x] = 0;
    hueless_.row(y + (y - 20) / 2)[x + (x - 20) / 2] = 255;
    EXPECT_EQ(count(found()), 0) << x << " " << y;
  }
}

TEST_F(HuelessTest, OnlyWithinTheRegion) {
  paint({14, 10, 8});
  const Mask skin = found({2, 3, 5, 6});
  EXPECT_EQ(count(skin), 9);
  EXPECT_TRUE(skin.at(2, 3) && skin.at(4, 5));
  EXPECT_EQ(count(found({36, 0, 40, 40})), 160);
}

}  // namespace
}  // namespace enc::segmentation
