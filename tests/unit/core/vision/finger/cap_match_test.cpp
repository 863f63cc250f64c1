// How far a cap is, on drawn pairs of which place, outline and slope are known: near ones and at the image's
// edge, where the finger is seen aslant and the eyes see different sides of it.
#include "core/vision/finger/cap_match.h"

#include <array>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "core/vision/finger/cap_fit.h"
#include "core/vision/finger/tangent.h"
#include "core/vision/stereo/triangulate.h"
#include "tests/unit/core/vision/finger/drawn_hand.h"

namespace enc {
namespace {

using drawn::small;

const RectifiedPair kPair{360.5, 159.5, 119.5, 0.09, Mat3::Identity()};

// A pair, and what is true of it.
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

// Matched without perspective, or with what one eye does not see, these are off by 0.3 to 0.8 px.
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
  const CapDisparity alone = scene.match(wrong);  // the best that there is near it, and it says how bad
  EXPECT_TRUE(!alone.good || alone.variance > 5.0 * scene.match(first).variance);
  EXPECT_FALSE(scene.match({}).good);
}

// Skin that is alike every 8 px along a finger that lies along the rows: both places fit equally well, but at
// one of them the finger would not end where it does.
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

// Not smoothed, these are off by 0.37 px rms; as it is, by 0.17.
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

// 2.4 radii from where the search for the cap begins there is no image any more.
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

}  // namespace
}  // namespace enc
