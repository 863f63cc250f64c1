// The skin model from images and masks: the parameters of the synthetic skin, also over red; refusals.
#include "core/vision/segmentation/skin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/vision/segmentation/change.h"
#include "core/vision/segmentation/kernels/hue.h"
#include "core/vision/segmentation/tiles.h"

namespace enc::segmentation {
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

// Within 1 % of the synthetic parameters: the mean as a share of the spread if it lies at 0.
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

// Counts of found and of true pixels; an ROC whose rates grow with the thresholds.

TEST(Roc, CountsWhatIsFoundAndWhatIsThere) {
  Mask found(5, 2), truth(5, 2);
  found.on = {255, 255, 255, 0, 0, 0, 0, 0, 0, 0};
  truth.on = {255, 255, 0, 255, 0, 0, 0, 0, 0, 0};
  const Confusion c = compare(found, truth);
  EXPECT_EQ(c.true_positive, 2);
  EXPECT_EQ(c.false_positive, 1);
  EXPECT_EQ(c.false_negative, 1);
  EXPECT_EQ(c.true_negative, 6);
  EXPECT_DOUBLE_EQ(c.correct(), 0.8);
  EXPECT_DOUBLE_EQ(c.false_positives(), 0.1);
  EXPECT_DOUBLE_EQ(c.false_negatives(), 0.1);
  EXPECT_DOUBLE_EQ(c.iou(), 0.5);
  EXPECT_DOUBLE_EQ(c.true_positive_rate(), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(c.false_positive_rate(), 1.0 / 7.0);
  EXPECT_EQ(compare(Mask(3, 3), Mask(3, 3)).iou(), 1.0);
  EXPECT_THROW((void)compare(Mask(3, 3), Mask(3, 2)), Error);
}

// The left half shows skin before blue; the right half shows skin in the background already.
TEST(Roc, GrowsWithBothThresholds) {
  Image background(40, 20), image(40, 20);
  Mask truth(40, 20);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 40; ++x) {
      const bool left = x < 20;
      const std::uint8_t skin[3] = {200, static_cast<std::uint8_t>(130 + x % 4 * 10), 100};
      const std::uint8_t blue[3] = {40, 60, 180};
      std::copy(skin, skin + 3, image.at(x, y));
      std::copy(left ? blue : skin, (left ? blue : skin) + 3, background.at(x, y));
      truth.row(y)[x] = left ? 255 : 0;
    }
  SegmentationSpec spec;
  spec.model = {.hue = 0.47, .spread = 0.1};
  const SegmentationPair pair{{background.view()}, image.view(), &truth};
  const double match[] = {0.0, 0.5, 1.01}, skin[] = {0.0, 1.2, 4.0};
  const std::vector<RocPoint> points = roc(spec, {&pair, 1}, match, skin);
  ASSERT_EQ(points.size(), 9U);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(points[i].foreground, match[i / 3]);
    EXPECT_EQ(points[i].skin, skin[i % 3]);
    EXPECT_EQ(points[i].found.pixels(), 800);
    for (const std::size_t before : {i % 3 == 0 ? i : i - 1, i < 3 ? i : i - 3}) {
      EXPECT_GE(points[i].found.true_positive_rate(), points[before].found.true_positive_rate());
      EXPECT_GE(points[i].found.false_positive_rate(), points[before].found.false_positive_rate());
    }
  }
  EXPECT_EQ(points[2].found.true_positive_rate(), 0.0);  // everything matches
  EXPECT_EQ(points[5].found.iou(), 1.0);
  EXPECT_EQ(points[8].found.false_positive_rate(), 1.0);  // nothing does
  EXPECT_LT(points[4].found.true_positive_rate(), 1.0);   // narrower than the spread of this skin
  EXPECT_GT(points[4].found.true_positive_rate(), 0.0);
}

TEST(Roc, RefusesAPairWithoutTruthOrBackground) {
  const Image image(4, 4);
  const Mask truth(4, 4);
  SegmentationSpec spec;
  spec.model = {.hue = 0.4, .spread = 0.1};
  const double one[] = {1.0};
  for (const SegmentationPair& pair :
       {SegmentationPair{{}, image.view(), &truth}, SegmentationPair{{image.view()}, image.view(), nullptr}})
    EXPECT_THROW((void)roc(spec, {&pair, 1}, one, one), Error);
}

// Skin too dim for a hue of its own: the required surroundings and their reach, shadows on a background of
// skin's hue, and the light's colour.

constexpr int kSide = 40;
constexpr std::uint16_t kWhite[3] = {256, 256, 256};
using Levels = std::array<int, 3>;

class HuelessTest : public testing::Test {
 protected:
  HuelessTest() : hueless_(kSide, kSide) {
    for (auto* plane : {&background_.red, &background_.green, &background_.blue})
      plane->resize(std::size_t{kSide} * kSide);
    behind({150, 150, 150});
    std::fill(hueless_.on.begin(), hueless_.on.end(), std::uint8_t{255});
  }
  void paint(const Levels& colour, double noise = 0.0) {
    std::mt19937 random(5);
    std::normal_distribution<double> gauss(0.0, noise > 0.0 ? noise : 1.0);
    for (std::size_t i = 0; i < image_.rgb.size(); ++i)
      image_.rgb[i] = static_cast<std::uint8_t>(
          std::clamp(std::round(colour[i % 3] + (noise > 0.0 ? gauss(random) : 0.0)), 0.0, 255.0));
  }
  void behind(const Levels& colour) {
    std::fill(background_.red.begin(), background_.red.end(), static_cast<std::uint8_t>(colour[0]));
    std::fill(background_.green.begin(), background_.green.end(), static_cast<std::uint8_t>(colour[1]));
    std::fill(background_.blue.begin(), background_.blue.end(), static_cast<std::uint8_t>(colour[2]));
  }
  // Hues of 10 to 33 degrees are skin.
  Mask found(const Region& region = {0, 0, kSide, kSide}, const std::uint16_t (&white)[3] = kWhite) {
    Mask skin(kSide, kSide);
    HuelessChange hueless(kSide);
    for (int i = 0; i < 2; ++i)  // nothing remains of earlier frames
      hueless.find(image_.view(), background_, hueless_, region, white, cut_of({43, 100}, HueRule{}), skin);
    return skin;
  }
  static int count(const Mask& mask) {
    return static_cast<int>(std::count(mask.on.begin(), mask.on.end(), 255));
  }
  bool in_the_middle(const Levels& colour) {
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

// A brown background in a shadow.
TEST_F(HuelessTest, ABackgroundOfSkinsHueKeepsItsShadow) {
  paint({15, 11, 9});
  behind({60, 45, 38});
  EXPECT_EQ(count(found()), 0);
  behind({38, 45, 60});
  EXPECT_EQ(count(found()), kSide * kSide);
}

// Two pixels, 2 px and 3 px apart, each of which alone is not enough.
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

// The published method: eq. 1 on tiles worked by hand, tiles without a hue, tiles at the image's edge.

using Rgb = std::array<std::uint8_t, 3>;
constexpr Rgb kRed{200, 20, 20}, kGreen{20, 200, 20}, kBlue{20, 20, 200}, kGrey{90, 90, 90},
    kPaper{250, 250, 250}, kBlack{0, 0, 0};

// The first `first` pixels have one colour, the rest another.
Image filled(int width, int height, const Rgb& a, const Rgb& b = {}, int first = 1 << 20) {
  Image image(width, height);
  for (int i = 0; i < width * height; ++i) {
    const Rgb& c = i < first ? a : b;
    std::copy(c.begin(), c.end(), image.at(i % width, i / width));
  }
  return image;
}

// H of one tile: the largest share that still counts as matched. Everything is skin, so the rest of the tile
// is foreground.
double intersection(const Image& seen, const Image& model, int tile = 5) {
  const Cut cut = cut_of({0, kHues}, HueRule{});
  const Grid grid{seen.width, seen.height, tile};
  Tiles tiles(kernels(), grid, 8);
  tiles.learn(model, cut);
  const int pixels = seen.width * seen.height;
  for (int common = pixels; common > 0; --common) {
    Mask out(seen.width, seen.height);
    tiles.candidates(seen.view(), out.whole(), static_cast<double>(common) / pixels, cut, out);
    if (std::count(out.on.begin(), out.on.end(), 255) == 0) return static_cast<double>(common) / pixels;
  }
  return 0.0;
}

TEST(Tiles, HaveTheIntersectionOfEquation1) {
  const Image red = filled(5, 5, kRed), green = filled(5, 5, kGreen);
  EXPECT_EQ(intersection(red, red), 1.0);
  EXPECT_EQ(intersection(red, green), 0.0);
  EXPECT_EQ(intersection(filled(4, 4, kRed, kGreen, 8), filled(4, 4, kRed), 4), 0.5);
  EXPECT_EQ(intersection(filled(4, 4, kRed), filled(4, 4, kRed, kGreen, 8), 4), 0.5);
  EXPECT_EQ(intersection(filled(5, 5, kRed, kGreen, 10), filled(5, 5, kRed, kBlue, 15)), 0.4);
  EXPECT_EQ(intersection(filled(5, 5, kRed, kGreen, 10), filled(5, 5, kGreen, kRed, 10)), 20.0 / 25.0);
  EXPECT_EQ(intersection(filled(15, 15, kRed), filled(15, 15, kRed), 15),
            1.0);  // 225 pixels: a byte holds them
}

// A grey tile has no hue: it matches other grey ones, but neither a hand nor OpenCV's hue 0, which is red.
TEST(Tiles, WithoutAHueAreAlikeAndUnlikeTheRest) {
  const Image grey = filled(5, 5, kGrey);
  EXPECT_EQ(intersection(filled(5, 5, kGrey, kRed, 24), filled(5, 5, kPaper, kRed, 24)), 1.0);
  const Image red = filled(5, 5, kRed);
  EXPECT_EQ(intersection(red, grey), 0.0);
  EXPECT_EQ(intersection(filled(5, 5, kRed, kGrey, 5), filled(5, 5, kBlack, kRed, 20)), 1.0);
  EXPECT_EQ(intersection(filled(5, 5, kRed, kGrey, 5), filled(5, 5, kGreen, kGrey, 5)), 0.8);
}

TEST(Tiles, NeedAWholeNumberOfPixels) {
  EXPECT_EQ(needed(0.5, 25), 13);
  EXPECT_EQ(needed(0.5, 24), 12);
  EXPECT_EQ(needed(0.6, 25), 15);  // not 16 from rounding
  EXPECT_EQ(needed(0.0, 25), 0);
  EXPECT_EQ(needed(1.0, 25), 25);
  EXPECT_EQ(needed(7.0, 25), 26);  // never reached: all is foreground
}

// 13 x 12: the last tiles have 3 columns, 2 rows or both; each differs in its own pixels only.
TEST(Tiles, AtTheEdgeAreJudgedByWhatTheyHave) {
  const Cut cut = cut_of({0, kHues}, HueRule{});
  const Grid grid{13, 12, 5};
  for (const Kernels* kernels : {&plain_kernels(), &segmentation::kernels()})
    for (int row = 0; row < grid.rows(); ++row)
      for (int column = 0; column < grid.columns(); ++column) {
        Tiles tiles(*kernels, grid, 8);
        tiles.learn(filled(13, 12, kRed), cut);
        Image image = filled(13, 12, kRed);
        const Region tile = grid.tile_at(column, row);
        for (int y = tile.y0; y < tile.y1; ++y)
          for (int x = tile.x0; x < tile.x1; ++x) std::copy(kBlue.begin(), kBlue.end(), image.at(x, y));
        Mask out(13, 12);
        tiles.candidates(image.view(), out.whole(), 0.5, cut, out);
        for (int y = 0; y < 12; ++y)
          for (int x = 0; x < 13; ++x) ASSERT_EQ(out.at(x, y), tile.contains(x, y)) << x << " " << y;
      }
}

}  // namespace
}  // namespace enc::segmentation
