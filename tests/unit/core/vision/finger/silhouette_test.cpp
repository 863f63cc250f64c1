// Where a fingertip is in the right image by its shape, with skin that has no detail at all.
#include "core/vision/finger/silhouette.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "core/vision/stereo/triangulate.h"
#include "tests/unit/core/vision/finger/drawn_hand.h"

namespace enc {
namespace {

using drawn::small;

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

// From all sides, along the rows as well; pointing away from the cameras and towards them.
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

}  // namespace
}  // namespace enc
