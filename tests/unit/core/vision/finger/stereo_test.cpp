// A finger in two images: the distance of its cap, and the detection of exchanged images.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "core/vision/finger/cap.h"
#include "core/vision/finger/fingertip.h"
#include "core/vision/stereo/match.h"
#include "core/vision/stereo/rectify.h"
#include "tests/unit/core/vision/finger/drawn_hand.h"

namespace enc {
namespace {

using drawn::small;

// The distance of a cap, on drawn pairs with known place, outline and slope: near ones, and at the image's
// edge, where the view is oblique and the eyes see different sides.

const RectifiedPair kPair{360.5, 159.5, 119.5, 0.09, Mat3::Identity()};

// A pair and its ground truth.
struct Scene {
  Grey left, right;
  Mask skin;
  Fingertip tip;
  double disparity, slope, front;

  explicit Scene(const drawn::HandAt& hand, int lighter = 0, std::uint64_t noise = 1)
      : left(320, 240), right(320, 240), skin(320, 240) {
    Image a, b;
    drawn::draw(small(), Side::left, &hand, noise, 1.5, a, &skin);
    drawn::draw(small(), Side::right, &hand, noise, 1.5, b);
    for (std::uint8_t& level : a.rgb) level = static_cast<std::uint8_t>(std::min(255, level + lighter));
    to_grey(a.view(), skin.whole(), left);
    to_grey(b.view(), skin.whole(), right);
    const Triplet at = seen_at(kPair, Point<'C'>(hand.tip));
    const Tangent tangent(kPair, {at.column, at.row});
    const Vec3 back = -hand.along.normalized();
    const double x = back.dot(tangent.right()), y = back.dot(tangent.down()), flat = std::hypot(x, y);
    const double sine = hand.radius / hand.tip.norm();
    tip.column = at.column;
    tip.row = at.row;
    tip.outline = kPair.focal * sine / std::sqrt(1.0 - sine * sine);
    tip.along_x = x / flat;
    tip.along_y = y / flat;
    disparity = at.disparity;
    slope = std::asin(back.dot(tangent.view()));
    front = disparity * (1.0 + 0.9 * tip.outline / kPair.focal);
  }
  [[nodiscard]] CapDisparity match(std::span<const float> surfaces) const {
    return match_cap(left, right, skin, tip, kPair, surfaces);
  }
};
drawn::HandAt cap_hand_at(const Vec3& tip, const Vec3& along, double radius = 0.010) {
  return {.tip = tip, .along = along, .radius = radius, .length = 0.05};
}

// A match without perspective, or one that includes parts that one eye does not see, errs here by 0.3 to 0.8
// px.
TEST(CapMatch, ACapAtTheEdgeOfTheImageIsAsFarAsItIs) {
  for (const Vec3& along : {Vec3(1, 0.2, 0), Vec3(-1, 0.2, 0), Vec3(0.1, -1, 0)})
    for (const Vec3& tip : {Vec3(0.10, 0.04, 0.32), Vec3(0.02, -0.05, 0.32), Vec3(0.12, 0.06, 0.55)}) {
      const Scene scene(cap_hand_at(tip, along));
      const std::array<float, 1> surface{static_cast<float>(scene.front)};
      const CapDisparity found = scene.match(surface);
      ASSERT_TRUE(found.good) << tip.transpose() << " / " << along.transpose();
      EXPECT_NEAR(found.disparity, scene.disparity, 0.12) << tip.transpose() << " / " << along.transpose();
      EXPECT_NEAR(found.slope, scene.slope, 0.25);
    }
}

TEST(CapMatch, FindsHowTheFingerSlopes) {
  for (const double away : {-0.5, 0.5}) {
    const Scene scene(cap_hand_at({0.05, 0.02, 0.35}, {0.4, -0.8, away}));
    const std::array<float, 1> surface{static_cast<float>(scene.front)};
    const CapDisparity found = scene.match(surface);
    ASSERT_TRUE(found.good);
    EXPECT_NEAR(found.disparity, scene.disparity, 0.15);
    EXPECT_NEAR(found.slope, scene.slope, 0.2);
    EXPECT_LT(found.variance, 0.01);
  }
}

TEST(CapMatch, ABlockOfTheBackgroundIsNotBelieved) {
  const Scene scene(cap_hand_at({0.05, 0.02, 0.45}, {0.4, -0.8, 0.1}));
  const auto front = static_cast<float>(scene.front);
  const std::array<float, 3> first{front, 50.0F, 95.0F}, last{95.0F, 50.0F, front};
  const std::array<float, 1> wrong{50.0F};
  ASSERT_TRUE(scene.match(first).good && scene.match(last).good);
  EXPECT_NEAR(scene.match(first).disparity, scene.disparity, 0.12);
  EXPECT_NEAR(scene.match(last).disparity, scene.disparity, 0.12);
  const CapDisparity alone = scene.match(wrong);  // the best match near it, with its poor score
  EXPECT_TRUE(!alone.good || alone.variance > 5.0 * scene.match(first).variance);
  EXPECT_FALSE(scene.match({}).good);
}

// Skin that repeats every 8 px along a finger along the rows: both places fit equally well, but at one of
// them the finger would end too early or too late.
TEST(CapMatch, TheFingersEndTellsPlacesApartThatLookAlike) {
  for (const double way : {-1.0, 1.0}) {
    const drawn::HandAt hand = cap_hand_at({0.06, 0.02, 0.45}, {way, 0.0, 0.0}, 0.010);
    Scene scene(hand);
    Image ignored;
    Mask there(320, 240);
    drawn::draw(small(), Side::right, &hand, 1, 1.5, ignored, &there);
    const auto alike = [](double x) {
      return static_cast<std::uint8_t>(std::lround(150.0 + 20.0 * std::sin(2.0 * M_PI * x / 8.0)));
    };
    for (int y = 0; y < 240; ++y)
      for (int x = 0; x < 320; ++x) {
        *scene.left.at(x, y) = scene.skin.at(x, y) ? alike(x) : std::uint8_t{60};
        *scene.right.at(x, y) = there.at(x, y) ? alike(x + scene.disparity) : std::uint8_t{60};
      }
    const auto front = static_cast<float>(scene.front);
    for (const float aside : {-8.0F, 8.0F}) {
      const std::array<float, 2> first{front, front + aside}, last{front + aside, front};
      EXPECT_NEAR(scene.match(first).disparity, scene.disparity, 1.5) << way << aside;
      EXPECT_NEAR(scene.match(last).disparity, scene.disparity, 1.5) << way << aside;
    }
  }
}

TEST(CapMatch, OneImageMayBeBrighter) {
  const drawn::HandAt hand = cap_hand_at({0.05, 0.02, 0.45}, {0.4, -0.8, 0.1});
  const Scene same(hand), brighter(hand, 20);
  const std::array<float, 1> surface{static_cast<float>(same.front)};
  EXPECT_NEAR(brighter.match(surface).disparity, same.match(surface).disparity, 0.02);
}

// The error is 0.37 px rms without smoothing, and 0.17 with it.
TEST(CapMatch, SkinOfLittleDetailSeenFromNearIsMoreThanNoise) {
  drawn::HandAt hand = cap_hand_at({0.03, 0.0, 0.30}, {0.9, -0.3, 0.1}, 0.020);
  hand.marks = 0.01;
  double squares = 0.0;
  constexpr int kPairs = 12;
  for (std::uint64_t noise = 1; noise <= kPairs; ++noise) {
    const Scene scene(hand, 0, noise);
    const std::array<float, 1> surface{static_cast<float>(scene.front)};
    const CapDisparity found = scene.match(surface);
    ASSERT_TRUE(found.good);
    squares += (found.disparity - scene.disparity) * (found.disparity - scene.disparity);
  }
  EXPECT_LT(std::sqrt(squares / kPairs), 0.25);
}

TEST(CapMatch, SpecksAreLeftOut) {
  const drawn::HandAt hand = cap_hand_at({0.05, 0.02, 0.40}, {0.4, -0.8, 0.3}, 0.012);
  Scene scene(hand);
  const double x = scene.tip.column, y = scene.tip.row;
  const std::array<float, 1> surface{static_cast<float>(scene.front)};
  const CapDisparity clean = scene.match(surface);
  for (const auto& [dx, dy] : {std::pair{-4, 3}, {1, -5}, {5, 2}, {-2, 6}, {3, 3}, {-6, -2}})
    *scene.right.at(static_cast<int>(x - scene.disparity) + dx, static_cast<int>(y) + dy) = 255;
  const CapDisparity found = scene.match(surface);
  ASSERT_TRUE(clean.good && found.good);
  EXPECT_NEAR(found.disparity, clean.disparity, 0.05);
  EXPECT_LT(found.left_over, 3.0 * clean.left_over);
}

// The image ends 2.4 radii from the start of the search for the cap.
TEST(CapFit, ACapThatEntersTheImageFromBelowIsFitted) {
  const Scene scene(cap_hand_at({0.0, 0.0660, 0.30}, {0.05, -1, 0}, 0.012));
  const Pixel start{scene.tip.column, scene.tip.row + 0.75 * scene.tip.outline};
  ASSERT_GT(start.row + 2.4 * scene.tip.outline, 240.0);
  const CapFit fit = fit_cap(scene.skin, kPair, start, scene.tip.outline);
  ASSERT_TRUE(fit.good);
  EXPECT_NEAR(fit.centre.row, scene.tip.row, 0.4);
  EXPECT_NEAR(fit.radius, scene.tip.outline, 0.3);
}

TEST(CapFit, ACapAtTheEdgeOfTheImageIsACircleSeenStraightOn) {
  RectifiedPair flat = kPair;
  flat.focal = 1e6;
  double apart = 0.0;
  for (const Vec3& along : {Vec3(1, 0.2, 0), Vec3(-1, 0.2, 0), Vec3(0.1, -1, 0)}) {
    const Scene scene(cap_hand_at({0.10, 0.05, 0.30}, along, 0.012));
    const Pixel start{scene.tip.column + 3.0 * scene.tip.along_x, scene.tip.row + 3.0 * scene.tip.along_y};
    const CapFit fit = fit_cap(scene.skin, kPair, start, scene.tip.outline);
    ASSERT_TRUE(fit.good);
    EXPECT_NEAR(fit.centre.column, scene.tip.column, 0.2);
    EXPECT_NEAR(fit.centre.row, scene.tip.row, 0.2);
    EXPECT_NEAR(fit.radius, scene.tip.outline, 0.15);
    EXPECT_NEAR(fit.along_x, scene.tip.along_x, 0.1);
    const CapFit without = fit_cap(scene.skin, flat, start, scene.tip.outline);
    apart = std::max(apart, std::abs(without.radius - scene.tip.outline));
  }
  EXPECT_GT(apart, 0.4);  // without perspective
}

// The place of a fingertip in the right image by its shape, with skin without any detail.

const RectifiedPair kSmall{360.5, 159.5, 119.5, 0.09, Mat3::Identity()};

struct Outline {
  Mask left{320, 240}, right{320, 240};
  Fingertip tip;
  double disparity;

  explicit Outline(const drawn::HandAt& hand) {
    Image image;
    drawn::draw(small(), Side::left, &hand, 1, 0.0, image, &left);
    drawn::draw(small(), Side::right, &hand, 1, 0.0, image, &right);
    const Triplet at = seen_at(kSmall, Point<'C'>(hand.tip));
    tip.column = at.column;
    tip.row = at.row;
    tip.outline = kSmall.focal * hand.radius / hand.tip.z();
    disparity = at.disparity;
  }
};
drawn::HandAt small_hand(const Vec3& tip, const Vec3& along) {
  return {.tip = tip, .along = along, .radius = 0.010, .length = 0.05};
}
ShiftRange round(double disparity) {
  return {static_cast<int>(0.6 * disparity), static_cast<int>(1.6 * disparity)};
}

// Fingers from all sides, also along the rows, pointing away from the cameras and towards them.
TEST(SilhouetteLong, TheShiftIsThatOfTheTip) {
  for (int side = 0; side < 16; ++side)
    for (const double away : {-0.5, 0.0, 0.5}) {
      const double angle = M_PI / 8.0 * side;
      const Outline scene(small_hand({0.05, 0.01, 0.4}, {std::cos(angle), std::sin(angle), away}));
      std::array<float, 4> shifts{};
      const std::size_t count =
          alike_shapes(scene.left, scene.right, scene.tip, round(scene.disparity), shifts);
      ASSERT_GE(count, 1U);
      EXPECT_NEAR(static_cast<double>(shifts[0]), scene.disparity, 2.5) << side << " / " << away;
    }
}

TEST(Silhouette, ReadsOnlyWhatItSays) {
  Outline scene(small_hand({0.02, 0.0, 0.5}, {1, 0.1, 0.2}));
  const ShiftRange range = round(scene.disparity);
  std::array<float, 4> before{}, after{};
  const std::size_t count = alike_shapes(scene.left, scene.right, scene.tip, range, before);
  const Region read = opposite(scene.tip, range, scene.right.whole());
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x)
      if (!read.contains(x, y)) scene.right.row(y)[x] = 255;
  EXPECT_EQ(alike_shapes(scene.left, scene.right, scene.tip, range, after), count);
  EXPECT_EQ(before, after);
}

TEST(Silhouette, ABackgroundOfTheHueOfSkinTellsNothing) {
  Outline scene(small_hand({0.02, 0.0, 0.5}, {0, -1, 0}));
  std::fill(scene.right.on.begin(), scene.right.on.end(), std::uint8_t{255});
  std::array<float, 4> shifts{};
  EXPECT_EQ(alike_shapes(scene.left, scene.right, scene.tip, round(scene.disparity), shifts), 0U);
  Outline edge(small_hand({-0.09, 0.0, 0.4}, {0, -1, 0}));  // some shifts lead out of the right image
  ASSERT_LT(edge.tip.column - edge.tip.outline, 1.6 * edge.disparity);
  std::fill(edge.right.on.begin(), edge.right.on.end(), std::uint8_t{255});
  EXPECT_EQ(alike_shapes(edge.left, edge.right, edge.tip, round(edge.disparity), shifts), 0U);
}

TEST(Silhouette, NoMoreThanThereIsRoomFor) {
  const Outline scene(small_hand({0.02, 0.0, 0.5}, {0, -1, 0}));
  std::array<float, 1> one{};
  EXPECT_EQ(alike_shapes(scene.left, scene.right, scene.tip, round(scene.disparity), one), 1U);
  EXPECT_EQ(alike_shapes(scene.left, scene.right, scene.tip, round(scene.disparity), {}), 0U);
}

// The tracker detects exchanged images in the first frame that shows enough, and never otherwise.

Grey grey_of(const Image& image) {
  Grey grey(image.width, image.height);
  to_grey(image.view(), {0, 0, image.width, image.height}, grey);
  return grey;
}

class ExchangedTest : public testing::Test {
 protected:
  StereoRig rig = drawn::small();
  ExchangeCheck watch{Rectifier(rig).pair(), 320, 240};
  static Grey bare() {
    Grey grey(320, 240);
    std::fill(grey.level.begin(), grey.level.end(), std::uint8_t{90});
    return grey;
  }
};

TEST_F(ExchangedTest, IsSeenAtOnceAndEndsAtOnce) {
  drawn::HandAt hand{.tip = {0.0, 0.0, 0.45}};
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const drawn::Pair pair = drawn::pair_of(rig, &hand, seed);
    const Grey left = grey_of(pair.left), right = grey_of(pair.right);
    EXPECT_FALSE(watch.see(left, right)) << seed;
    EXPECT_TRUE(watch.see(right, left)) << seed;
    EXPECT_FALSE(watch.see(left, right)) << seed;
  }
}

TEST_F(ExchangedTest, WhatShowsNothingChangesNothing) {
  const drawn::Pair pair = drawn::pair_of(rig, nullptr);
  const Grey left = grey_of(pair.left), right = grey_of(pair.right);
  EXPECT_FALSE(watch.see(bare(), bare()));
  EXPECT_TRUE(watch.see(right, left));
  EXPECT_TRUE(watch.see(bare(), bare()));
}

// Two unrelated images are neither exchanged nor right.
TEST_F(ExchangedTest, NoiseIsNoSign) {
  const auto noisy = [](std::uint64_t seed) {
    Grey grey(320, 240);
    for (int y = 0; y < 240; ++y)
      for (int x = 0; x < 320; ++x)
        *grey.at(x, y) =
            static_cast<std::uint8_t>(255.0 * drawn::hashed(x, y, static_cast<std::int64_t>(seed)));
    return grey;
  };
  for (std::uint64_t seed = 0; seed < 20; ++seed) EXPECT_FALSE(watch.see(noisy(seed), noisy(seed + 100)));
}

// The tracker accepts a pair of cameras far apart, or of few pixels.
TEST_F(ExchangedTest, AnyRigIsLookedAt) {
  RectifiedPair wide = Rectifier(rig).pair();
  wide.baseline = 1.0;
  EXPECT_NO_THROW(ExchangeCheck(wide, 320, 240));
  ExchangeCheck tiny(Rectifier(rig).pair(), 8, 4);
  EXPECT_FALSE(tiny.see(Grey(8, 4), Grey(8, 4)));
}

// The outline of a sphere in an image, and the axis of a camera's view.

const RectifiedPair kAhead{721, 319.5, 239.5, 0.09, Mat3::Identity()};

// 12 mm of radius at 300 mm, in a corner: 29 px, and 2 px more from the image's middle outwards.
TEST(Tangent, ASpheresOutlineIsACircleRoundItsMiddle) {
  const Vec3 centre(0.11, -0.08, 0.30);
  const double radius = 0.012, distance = centre.norm();
  const Pixel middle{319.5 + 721 * centre.x() / centre.z(), 239.5 + 721 * centre.y() / centre.z()};
  const Tangent tangent(kAhead, middle);
  const Vec3 along = centre / distance, a = centre.unitOrthogonal(), b = along.cross(a);
  const double sine = radius / distance, cosine = std::sqrt(1.0 - sine * sine);
  double least = 1e9, most = 0.0;
  for (int i = 0; i < 100; ++i) {
    const double angle = 0.02 * i * std::numbers::pi;
    // A ray that touches the sphere.
    const Vec3 rim = cosine * along + sine * (std::cos(angle) * a + std::sin(angle) * b);
    const Pixel seen{319.5 + 721 * rim.x() / rim.z(), 239.5 + 721 * rim.y() / rim.z()};
    const Pixel flat = tangent.of(seen);
    EXPECT_NEAR(std::hypot(flat.column, flat.row), 721 * sine / cosine, 1e-9);
    const Pixel back = tangent.image(flat);
    EXPECT_NEAR(back.column, seen.column, 1e-9);
    EXPECT_NEAR(back.row, seen.row, 1e-9);
    const double in_image = std::hypot(seen.column - middle.column, seen.row - middle.row);
    least = std::min(least, in_image);
    most = std::max(most, in_image);
  }
  EXPECT_GT(most - least, 3.0);
}

TEST(Tangent, InTheMiddleItIsTheImage) {
  const Tangent tangent(kAhead, {319.5, 239.5});
  const Pixel flat = tangent.of({331.5, 230.5});
  EXPECT_NEAR(flat.column, 12.0, 1e-12);
  EXPECT_NEAR(flat.row, -9.0, 1e-12);
}

}  // namespace
}  // namespace enc
