// The whole segmentation by both methods: a region gives the bits of the whole frame; learning and refusals;
// images of all sizes, black and saturated ones; other light, and a background of the hue of skin.
#include "core/vision/segmentation/segmenter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/vision/segmentation/light.h"
#include "core/vision/segmentation/skin.h"
#include "core/vision/segmentation/tiles.h"

namespace enc::segmentation {
namespace {

constexpr SegmentationMethod kBoth[] = {SegmentationMethod::published, SegmentationMethod::ours};

using Colour = std::array<double, 3>;  // of 255
constexpr Colour kSkin{200, 150, 125}, kWall{130, 140, 165}, kDesk{70, 120, 80}, kWood{170, 127, 106};

struct Scene {
  Colour wall = kWall, skin = kSkin;
  std::function<Colour(double, double)> light = [](double, double) { return Colour{1, 1, 1}; };
  double noise = 1.5;
  int width = 320, height = 240;

  [[nodiscard]] bool hand(int x, int y) const {
    const double u = 320.0 * x / width, v = 240.0 * y / height;
    return std::hypot(u - 190.0, v - 170.0) < 65.0 || (std::abs(u - 160.0) < 11.0 && v > 40.0 && v < 170.0);
  }
  // The light changes only images with a hand.
  [[nodiscard]] Image draw(bool with_hand, std::uint32_t seed) const {
    std::mt19937 random(seed);
    std::normal_distribution<double> gauss(0.0, noise);
    Image image(width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const double u = static_cast<double>(x) / width, v = static_cast<double>(y) / height;
        const Colour c = with_hand && hand(x, y) ? skin : (v > 0.75 ? kDesk : wall);
        const double pattern = (x / 24 + y / 24) % 2 != 0 ? 1.0 : 0.85;
        const Colour lit = with_hand ? light(u, v) : Colour{1, 1, 1};
        for (std::size_t i = 0; i < 3; ++i)
          image.at(x, y)[i] = static_cast<std::uint8_t>(std::clamp(
              c[i] * (with_hand && hand(x, y) ? 1.0 : pattern) * lit[i] + gauss(random), 0.0, 255.0));
      }
    return image;
  }
  [[nodiscard]] Mask truth() const {
    Mask mask(width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) mask.row(y)[x] = hand(x, y) ? 255 : 0;
    return mask;
  }
};

SegmentationSpec spec_of(SegmentationMethod method) {
  SegmentationSpec spec;
  spec.method = method;
  spec.model = {.hue = 0.349, .spread = 0.05};  // kSkin
  return spec;
}

Segmenter learned(const SegmentationSpec& spec, const Scene& scene) {
  Segmenter segmenter(spec, scene.width, scene.height);
  for (std::uint32_t i = 0; !segmenter.learned(); ++i) segmenter.learn(scene.draw(false, 100 + i).view());
  return segmenter;
}

Confusion judged(SegmentationMethod method, const Scene& scene) {
  Segmenter segmenter = learned(spec_of(method), scene);
  Mask found(scene.width, scene.height);
  segmenter.segment(scene.draw(true, 7).view(), found.whole(), found);
  return compare(found, scene.truth());
}

TEST(Segmenter, FindsAHandByBothMethods) {
  for (const auto method : kBoth) EXPECT_GT(judged(method, {}).iou(), 0.97) << word_of(method);
}

TEST(Segmenter, GivesOfARegionTheBitsOfTheWhole) {
  std::mt19937 random(3);
  for (const auto& [width, height, wall] :
       {std::tuple{320, 240, kWood}, {123, 77, kWood}, {320, 240, kWall}, {123, 77, kWall}})
    for (const auto method : kBoth) {
      Scene scene{.wall = wall, .light = [](double u, double) {
                    return Colour{0.6 + 0.8 * u, 0.6 + 0.8 * u, 0.6 + 0.8 * u};
                  }};
      scene.width = width;
      scene.height = height;
      Segmenter segmenter = learned(spec_of(method), scene);
      Image image = scene.draw(true, 9);
      for (int i = 0; i < width * height / 2; ++i)  // speckles before wood: each pixel's neighbours decide
        if (random() % 2 != 0)
          for (int c = 0; c < 3; ++c)
            image.at(i % width, i / width)[c] = static_cast<std::uint8_t>(kSkin[static_cast<std::size_t>(c)]);
      for (int i = width * height / 2; i < width * height * 3 / 4; ++i)  // and pixels without a hue alone
        if (random() % 2 != 0)
          for (int c = 0; c < 3; ++c)
            image.at(i % width, i / width)[c] =
                static_cast<std::uint8_t>(0.1 * kSkin[static_cast<std::size_t>(c)] + random() % 4);
      Image other(width, height);  // so that nothing is left of an earlier frame
      for (std::size_t i = 0; i < other.rgb.size(); ++i)
        other.rgb[i] = static_cast<std::uint8_t>(kSkin[i % 3]);
      Mask whole(width, height);
      segmenter.segment(image.view(), whole.whole(), whole);
      const auto at = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
      for (int i = 0; i < 40; ++i) {
        const int x = at(width), y = at(height);
        const Region wanted{x - 3, y - 3, x + 1 + at(90), y + 1 + at(70)};
        Mask part(width, height);
        segmenter.segment(i % 2 == 0 ? other.view() : scene.draw(false, 1).view(), part.whole(), part);
        std::fill(part.on.begin(), part.on.end(), std::uint8_t{7});
        const Region done = segmenter.segment(image.view(), wanted, part);
        ASSERT_EQ(done, segmenter.on_grid(wanted));
        for (int v = 0; v < height; ++v)
          for (int u = 0; u < width; ++u) {
            ASSERT_TRUE(done.contains(u, v) || !wanted.contains(u, v));
            ASSERT_EQ(part.row(v)[u], done.contains(u, v) ? whole.row(v)[u] : 7)
                << word_of(method) << u << " " << v;
          }
      }
    }
}

// Stripes of wall, before which dim skin comes and goes, and of wood, which counts as skin if most pixels
// around it are skin. The surroundings of a region decide at its edge, and their own surroundings decide
// there.
TEST(Segmenter, GivesOfARegionTheBitsOfTheWholeWhereSurroundingsDecide) {
  constexpr int kWidth = 160, kHeight = 120;
  std::mt19937 random(11);
  const auto frame = [&](bool hand) {
    Image image(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const bool wood = x / 3 % 2 != 0, dim = hand && !wood && random() % 4 != 0;
        for (std::size_t c = 0; c < 3; ++c)
          image.at(x, y)[c] = static_cast<std::uint8_t>(dim ? 0.1 * kSkin[c] + random() % 5
                                                            : (wood ? kWood : kWall)[c] + random() % 3);
      }
    return image;
  };
  SegmentationSpec spec = spec_of(SegmentationMethod::ours);
  spec.tile = 1;  // nothing is rounded up
  Segmenter segmenter(spec, kWidth, kHeight);
  while (!segmenter.learned()) segmenter.learn(frame(false).view());
  const Image image = frame(true), other = frame(true), empty = frame(false);
  Mask whole(kWidth, kHeight), part(kWidth, kHeight);
  segmenter.segment(image.view(), whole.whole(), whole);
  const auto skin = std::count(whole.on.begin(), whole.on.end(), 255);
  EXPECT_GT(skin, kWidth * kHeight / 10);
  EXPECT_LT(skin, kWidth * kHeight * 9 / 10);
  for (int i = 0; i < 400; ++i) {
    const int x = static_cast<int>(random() % kWidth), y = static_cast<int>(random() % kHeight);
    segmenter.segment(i % 2 == 0 ? other.view() : empty.view(), part.whole(), part);
    const Region done = segmenter.segment(image.view(), {x, y, x + 20, y + 20}, part);
    for (int v = done.y0; v < done.y1; ++v)
      for (int u = done.x0; u < done.x1; ++u) ASSERT_EQ(part.at(u, v), whole.at(u, v)) << u << " " << v;
  }
}

TEST(Segmenter, HasOneGridOfTiles) {
  const Segmenter segmenter(spec_of(SegmentationMethod::published), 33, 22);
  EXPECT_EQ(segmenter.on_grid({7, 7, 8, 8}), (Region{5, 5, 10, 10}));
  EXPECT_EQ(segmenter.on_grid({10, 5, 15, 10}), (Region{10, 5, 15, 10}));
  EXPECT_EQ(segmenter.on_grid({-9, -9, 99, 99}), (Region{0, 0, 33, 22}));
  EXPECT_EQ(segmenter.on_grid({31, 21, 32, 22}), (Region{30, 20, 33, 22}));
  EXPECT_TRUE(segmenter.on_grid({40, 0, 50, 9}).empty());
  EXPECT_TRUE(segmenter.on_grid({9, 9, 9, 12}).empty());
}

TEST(Segmenter, LearnsFromTheFirstFramesAlone) {
  const Scene scene;
  Segmenter segmenter(spec_of(SegmentationMethod::published), scene.width, scene.height);
  const Image empty = scene.draw(false, 1), hand = scene.draw(true, 2);
  Mask found(scene.width, scene.height), again = found;
  for (int i = 0; i < 9; ++i) {
    EXPECT_FALSE(segmenter.learn(empty.view()));
    EXPECT_THROW(segmenter.segment(hand.view(), found.whole(), found), Error) << i;
  }
  EXPECT_TRUE(segmenter.learn(empty.view()));
  segmenter.segment(hand.view(), found.whole(), found);
  EXPECT_TRUE(segmenter.learn(hand.view()));  // changes nothing
  segmenter.segment(hand.view(), again.whole(), again);
  EXPECT_EQ(found.on, again.on);
  EXPECT_EQ(segmenter.unrest(), 0.0);
}

TEST(Segmenter, SaysWhatMovedWhileItLearned) {
  const Scene scene;
  Segmenter segmenter(spec_of(SegmentationMethod::published), scene.width, scene.height);
  for (std::uint32_t i = 0; i < 10; ++i) segmenter.learn(scene.draw(i > 6, i).view());
  EXPECT_NEAR(segmenter.unrest(), 0.2, 0.05);  // the hand's share of the frame
}

TEST(Segmenter, RefusesFramesOfAnotherSizeAndSpecsThatCannotBe) {
  const SegmentationSpec good = spec_of(SegmentationMethod::published);
  Segmenter segmenter(good, 20, 10);
  const Image image(20, 10), turned(10, 20);
  EXPECT_THROW(segmenter.learn(turned.view()), Error);
  while (!segmenter.learn(image.view())) {
  }
  Mask mask(20, 10), wrong(20, 11);
  EXPECT_THROW(segmenter.segment(turned.view(), {0, 0, 5, 5}, mask), Error);
  EXPECT_THROW(segmenter.segment(image.view(), {0, 0, 5, 5}, wrong), Error);
  EXPECT_THROW(segmenter.thresholds(-1.0, 1.0), Error);
  EXPECT_THROW(Segmenter(good, 0, 10), Error);
  const auto refused = [&](const auto& spoil) {
    SegmentationSpec spec = good;
    spoil(spec);
    EXPECT_THROW(Segmenter(spec, 20, 10), Error);
  };
  refused([](auto& s) { s.background_frames = 0; });
  refused([](auto& s) { s.background_frames = 256; });
  refused([](auto& s) { s.tile = 16; });
  refused([](auto& s) { s.bins = 9; });
  refused([](auto& s) { s.median = 4; });
  refused([](auto& s) { s.median = 17; });
  refused([](auto& s) { s.match = NAN; });
  refused([](auto& s) { s.model.spread = 0.0; });
  refused([](auto& s) { s.model.hue = NAN; });
}

// Sizes from one pixel on; frames that are black, white, or a hand all over. Old background and grey are
// never skin.
TEST(Segmenter, TakesAnySizeAndAnyFrame) {
  for (const auto method : kBoth)
    for (const auto& [width, height] : {std::pair{1, 1}, {4, 3}, {7, 1}, {1, 31}, {33, 6}, {64, 48}}) {
      SegmentationSpec spec = spec_of(method);
      spec.background_frames = 1;
      for (const std::uint8_t before : {0, 128, 255}) {
        Segmenter segmenter(spec, width, height);
        Image image(width, height);
        std::fill(image.rgb.begin(), image.rgb.end(), before);
        segmenter.learn(image.view());
        for (const std::uint8_t now : {0, 128, 255}) {
          std::fill(image.rgb.begin(), image.rgb.end(), now);
          Mask found(width, height);
          segmenter.segment(image.view(), found.whole(), found);
          EXPECT_EQ(std::count(found.on.begin(), found.on.end(), 255), 0) << width << " " << height;
        }
        for (std::size_t i = 0; i < image.rgb.size(); ++i)
          image.rgb[i] = static_cast<std::uint8_t>(kSkin[i % 3]);
        Mask found(width, height);
        segmenter.segment(image.view(), found.whole(), found);
        const auto skin = std::count(found.on.begin(), found.on.end(), 255);
        const bool as_light = width * height > 1000;  // our method only, as in change.h
        EXPECT_TRUE(skin == width * height || as_light) << word_of(method) << " " << width;
      }
    }
}

// A lamp of another strength, side and colour.
TEST(Segmenter, OursHoldsInOtherLight) {
  const Scene plain;
  for (const auto& light : std::vector<std::function<Colour(double, double)>>{
           [](double, double) {
             return Colour{0.6, 0.6, 0.6};
           },
           [](double, double) {
             return Colour{1.2, 1.2, 1.2};
           },
           [](double u, double) {
             return Colour{0.8 + 0.4 * u, 0.8 + 0.4 * u, 0.8 + 0.4 * u};
           },
           [](double, double) {
             return Colour{1.1, 1.0, 0.8};
           },
           [](double, double) {
             return Colour{0.8, 0.95, 1.15};
           }}) {
    Scene scene;
    scene.light = light;
    EXPECT_GT(judged(SegmentationMethod::ours, scene).iou(), 0.95);
  }
}

// The published method uses the plain hue of skin: a bluer lamp moves it out of the model.
TEST(Segmenter, ThePublishedMethodLosesSkinInABluerLight) {
  Scene scene;
  scene.light = [](double, double) { return Colour{0.8, 0.95, 1.15}; };
  EXPECT_LT(judged(SegmentationMethod::published, scene).iou(), 0.1);
}

// No pixel has a hue: a chroma of 6, with 1.5 of noise.
TEST(Segmenter, OursSeesAHandTooDimForAHue) {
  Scene scene;
  scene.skin = {16, 12, 10};
  EXPECT_LT(judged(SegmentationMethod::published, scene).iou(), 0.1);
  EXPECT_GT(judged(SegmentationMethod::ours, scene).iou(), 0.9);
  scene.skin = {16, 16, 16};  // nor the hue of skin
  EXPECT_LT(judged(SegmentationMethod::ours, scene).iou(), 0.01);
}

// A shadow on brown: dim, and of the hue of skin.
TEST(Segmenter, OursTakesAShadowForNoHand) {
  Scene scene;
  scene.wall = {60, 45, 38};
  scene.light = [](double u, double) { return u < 0.25 ? Colour{0.5, 0.5, 0.5} : Colour{1, 1, 1}; };
  EXPECT_LT(judged(SegmentationMethod::ours, scene).false_positives(), 0.005);
}

TEST(Segmenter, OursSeesAHandBeforeWood) {
  Scene scene;
  scene.wall = kWood;  // the hue of kSkin to half a degree
  EXPECT_LT(judged(SegmentationMethod::published, scene).iou(), 0.5);
  EXPECT_GT(judged(SegmentationMethod::ours, scene).iou(), 0.95);
  scene.light = [](double u, double) { return Colour{0.8 + 0.4 * u, 0.8 + 0.4 * u, 0.8 + 0.4 * u}; };
  EXPECT_GT(judged(SegmentationMethod::ours, scene).iou(), 0.95);
  scene.light = [](double, double v) { return Colour{0.8 + 0.4 * v, 0.8 + 0.4 * v, 0.8 + 0.4 * v}; };
  EXPECT_GT(judged(SegmentationMethod::ours, scene).iou(), 0.95);
}

// Mean and noise of the background's frames.

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

// The estimated light of a frame: gains, a lamp at the side, the residual; behind a hand.

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

// Most of the background is clipped but a shaded hand before it is not: the hand alone gives no light.
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
