// The model of skin out of images and masks: what synthetic skin was made with, also over red; what is
// refused.
#include "core/vision/segmentation/skin.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace enc {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

// A saturated, bright colour of this hue.
void paint(std::uint8_t* rgb, double hue) {
  for (int c = 0; c < 3; ++c) {
    const double away = std::abs(std::remainder(hue - c * kTurn / 3.0, kTurn)) / (kTurn / 6.0);
    rgb[c] = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(2.0 - away, 0.0, 1.0)));
  }
}

struct Hands {
  Image image{400, 300};
  Mask mask{400, 300};
  Hands(double hue, double spread, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> gauss(hue, spread);
    for (int y = 0; y < 300; ++y)
      for (int x = 0; x < 400; ++x) {
        const bool hand = (x - 200) * (x - 200) + (y - 150) * (y - 150) < 140 * 140;
        mask.row(y)[x] = hand ? 255 : 0;
        paint(image.at(x, y), hand ? gauss(random) : 3.0);
      }
  }
};

// Within 1 % of what it was made with: the mean in shares of the spread where it lies at 0.
TEST(Skin, IsWhatItWasMadeWith) {
  std::uint32_t seed = 1;
  for (const double hue : {0.45, 0.0, kTurn - 0.05, 0.1, 2.1, 4.0})
    for (const double spread : {0.03, 0.12, 0.4}) {
      const Hands a(hue, spread, ++seed), b(hue, spread, ++seed);
      const ImageView images[] = {a.image.view(), b.image.view()};
      const Mask masks[] = {a.mask, b.mask};
      const SkinModel model = learn_skin(images, masks);
      EXPECT_NEAR(std::remainder(model.hue - hue, kTurn), 0.0,
                  0.01 * std::max(hue < 3.0 ? hue : kTurn - hue, spread))
          << hue << " " << spread;
      EXPECT_NEAR(model.spread / spread, 1.0, 0.01) << hue << " " << spread;
      EXPECT_GE(model.hue, 0.0);
      EXPECT_LT(model.hue, kTurn);
    }
}

TEST(Skin, ComesFromTheMaskAlone) {
  const Hands a(0.4, 0.05, 1);
  Hands b = a;
  for (int x = 0; x < 60; ++x) paint(b.image.at(x, 0), 5.0);
  const ImageView one[] = {a.image.view()}, two[] = {b.image.view()};
  EXPECT_EQ(learn_skin(one, {&a.mask, 1}).hue, learn_skin(two, {&b.mask, 1}).hue);
}

TEST(Skin, IgnoresGreyAndDarkPixels) {
  Image image(4, 1);
  Mask mask(4, 1);
  mask.on.assign(4, 255);
  const std::uint8_t pixels[4][3] = {{200, 150, 100}, {200, 150, 100}, {90, 90, 90}, {15, 0, 10}};
  for (int x = 0; x < 4; ++x) std::copy(pixels[x], pixels[x] + 3, image.at(x, 0));
  SkinLearner learner;
  learner.add(image.view(), mask);
  EXPECT_EQ(learner.pixels(), 2);
  EXPECT_NEAR(learner.model().hue, kTurn / 12.0, kTurn / segmentation::kHues);  // half a sextant
}

TEST(Skin, RefusesWhatItCannotLearnFrom) {
  SkinLearner learner;
  EXPECT_THROW((void)learner.model(), Error);
  const Image image(5, 4);
  EXPECT_THROW(learner.add(image.view(), Mask(4, 5)), Error);
  const ImageView images[] = {image.view()};
  EXPECT_THROW((void)learn_skin(images, {}), Error);
  Image six(6, 1);
  Mask all(6, 1);
  all.on.assign(6, 255);
  for (int x = 0; x < 6; ++x) paint(six.at(x, 0), x * kTurn / 6.0);
  learner.add(six.view(), all);
  EXPECT_THROW((void)learner.model(), Error);  // every hue alike
}

}  // namespace
}  // namespace enc
