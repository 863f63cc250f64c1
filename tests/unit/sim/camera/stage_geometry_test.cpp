// Where things are in the stage's pictures: a fingertip's cap, both cameras, bent lenses, depth.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "sim/camera/stage.h"
#include "sim/camera/warp.h"

namespace enc::sim {
namespace {

constexpr double kWidth = 0.020;  // m, of the finger

StageSpec still() {
  StageSpec spec;
  spec.sensor.noise = 0.0;
  return spec;
}

HandLook untapered() {
  HandLook look;
  look.finger_width = kWidth;
  look.taper = 1.0;
  return look;
}

// The middle of a sphere's outline in a picture, and its area.
struct Outline {
  double column, row, area;
};
Outline outline(const Lens& lens, const Vec3& centre, double radius) {
  const double share = radius * radius / centre.squaredNorm();
  const Vec3 a = centre.unitOrthogonal(), b = centre.normalized().cross(a);
  Outline o{0, 0, 0};
  std::array<double, 2> p{};
  for (int i = 0; i <= 720; ++i) {
    const double angle = std::numbers::pi * i / 360.0;
    const auto q = projected(lens, (1 - share) * centre + radius * std::sqrt(1 - share) *
                                                              (std::cos(angle) * a + std::sin(angle) * b));
    if (i > 0) {
      const double cross = 0.5 * (p[0] * q[1] - q[0] * p[1]);
      o.area += cross;
      o.column += cross * (p[0] + q[0]) / 3.0;
      o.row += cross * (p[1] + q[1]) / 3.0;
    }
    p = q;
  }
  return {o.column / o.area, o.row / o.area, std::abs(o.area)};
}

// The cap of a finger that points at the camera hides the finger: pixels as near as its middle.
Outline seen(const Lens& lens, const PixelTruth& truth, double distance) {
  Outline o{0, 0, 0};
  for (int y = 0; y < truth.skin.height; ++y)
    for (int x = 0; x < truth.skin.width; ++x) {
      if (!truth.skin.at(x, y)) continue;
      const auto [u, v] =
          undistorted(lens, (x - lens.centre_x) / lens.focal_x, (y - lens.centre_y) / lens.focal_y);
      const auto at = static_cast<std::size_t>(y * truth.skin.width + x);
      if (Vec3(u, v, 1.0).norm() * static_cast<double>(truth.depth[at]) > distance) continue;
      o.column += x;
      o.row += y;
      o.area += 1.0;
    }
  return {o.column / o.area, o.row / o.area, o.area};
}

void expect_in_place(const StageSpec& spec) {
  Stage stage(spec);
  Image left, right;
  PixelTruth truth;
  for (const Vec3& tip :
       {Vec3(0, 0, 0.3), Vec3(-0.08, -0.05, 0.3), Vec3(0.15, 0.09, 0.45), Vec3(-0.14, 0.10, 0.42)}) {
    const HandPose hand{Point<'C'>(tip), Vec<'C'>(Vec3(-tip)), 0.3};
    stage.draw(&hand, untapered(), {}, 0, left, right, &truth);
    const Outline there = seen(spec.camera.left, truth, tip.norm() + 0.001),
                  wanted = outline(spec.camera.left, tip, 0.5 * kWidth);
    EXPECT_NEAR(there.column, wanted.column, 0.1) << tip.transpose();
    EXPECT_NEAR(there.row, wanted.row, 0.1) << tip.transpose();
    EXPECT_NEAR(there.area / wanted.area, 1.0, 0.02) << tip.transpose();
    EXPECT_NEAR(truth.radius, std::sqrt(wanted.area / std::numbers::pi), 0.01);
    EXPECT_NEAR(truth.column, projected(spec.camera.left, tip)[0], 1e-9);
  }
}

TEST(StageGeometry, TheCapIsWhereAPinholeHasIt) { expect_in_place(still()); }

TEST(StageGeometry, AnOffAxisCameraWithUnequalFocalLengths) {
  StageSpec spec = still();
  spec.camera.left = {690.0, 702.0, 341.7, 228.2, {}};
  expect_in_place(spec);
}

TEST(StageGeometry, ABentLens) {
  StageSpec spec = still();
  spec.camera.left = {690.0, 702.0, 341.7, 228.2, {-0.25, 0.08, 0.001, -0.0008, 0.01}};
  expect_in_place(spec);
}

// Of the right camera there is no truth. So another stage looks with the same lens as its left camera, from
// where the right one is: there the cap has the same pixels, which are those that differ from the background.
TEST(StageGeometry, TheRightCameraIsWhereItsPoseSays) {
  StageSpec spec = still();
  spec.camera.X_CD = {Quat(Eigen::AngleAxisd(0.05, Vec3(0.3, -1.0, 0.4).normalized())),
                      Vec3(0.090, 0.004, -0.006)};
  spec.camera.right = {700.0, 703.0, 325.0, 230.0, {}};
  StageSpec turned = still();
  turned.camera.left = spec.camera.right;
  Stage stage(spec), from_there(turned);
  Image left, with, without;
  stage.draw(nullptr, {}, {}, 0, left, without);
  for (const Vec3& tip : {Vec3(0.06, 0.0, 0.42), Vec3(0.10, -0.05, 0.5), Vec3(-0.03, 0.03, 0.45)}) {
    const HandPose hand{Point<'C'>(tip), {0, -1, 0}, 0.0};
    stage.draw(&hand, untapered(), {}, 0, left, with);
    const Pose<'D', 'C'> X_DC = spec.camera.X_CD.inverse();
    const HandPose seen_there{Point<'C'>((X_DC * hand.tip).e()), Vec<'C'>((X_DC * hand.along).e()), 0.0};
    PixelTruth truth;
    Image other;
    from_there.draw(&seen_there, untapered(), {}, 0, left, other, &truth);
    int cap = 0, differ = 0;
    for (int y = 0; y < truth.row + truth.radius; ++y)
      for (int x = 0; x < 640; ++x) {
        const bool on = !std::equal(with.at(x, y), with.at(x, y) + 3, without.at(x, y));
        cap += on ? 1 : 0;
        differ += on != truth.skin.at(x, y) ? 1 : 0;
      }
    EXPECT_GT(cap, 500);
    EXPECT_LE(differ, 4) << tip.transpose();  // of about 60 along its edge: 0.1 px
  }
}

// A ball is where a pinhole has it, a rod and a box are as large as they are, and none of it is skin.
TEST(StageGeometry, ThingsAreWhereTheyAreShown) {
  const StageSpec spec = still();
  Stage stage(spec);
  Image left, right;
  PixelTruth truth;
  const auto pixels = [&](const Shown& shown) {
    stage.draw(shown, 0, left, right, &truth);
    Outline o{0, 0, 0};
    for (int y = 0; y < truth.things.height; ++y)
      for (int x = 0; x < truth.things.width; ++x) {
        if (!truth.things.at(x, y)) continue;
        o = {o.column + x, o.row + y, o.area + 1.0};
      }
    return Outline{o.column / o.area, o.row / o.area, o.area};
  };
  Shown shown;
  const Vec3 at(0.05, -0.03, 0.5);
  shown.things = {{ThingShape::sphere, Point<'C'>(at), Mat3::Identity(), {0.03, 0, 0}, {0.1F, 0.6F, 0.2F}}};
  const Outline ball = pixels(shown), wanted = outline(spec.camera.left, at, 0.03);
  EXPECT_NEAR(ball.column, wanted.column, 0.1);
  EXPECT_NEAR(ball.row, wanted.row, 0.1);
  EXPECT_NEAR(ball.area / wanted.area, 1.0, 0.01);

  const double px = spec.camera.left.focal_x / 0.5;  // of a metre at that depth
  const Mat3 along_x = Quat::FromTwoVectors(Vec3::UnitZ(), Vec3::UnitX()).toRotationMatrix();
  shown.things = {{ThingShape::capsule, Point<'C'>(0, 0, 0.5), along_x, {0.004, 0, 0.06}, {}}};
  const double edge = 0.5 / px * (2.0 * 0.12 + 2.0 * M_PI * 0.004);  // half a pixel all round
  EXPECT_NEAR(pixels(shown).area / (px * px), 0.12 * 0.008 + M_PI * 0.004 * 0.004, edge);
  shown.things = {{ThingShape::box, Point<'C'>(0, 0, 0.5), Mat3::Identity(), {0.04, 0.02, 1e-4}, {}}};
  EXPECT_NEAR(pixels(shown).area / (px * px), 0.08 * 0.04, 0.5 / px * 2.0 * (0.08 + 0.04));  // likewise

  // What is nearer hides what is behind it.
  shown.hand = true;
  shown.pose = {Point<'C'>(0, 0, 0.45), {0, -1, 0}, 0.0};
  const double shown_box = pixels(shown).area;
  EXPECT_LT(shown_box / (px * px), 0.9 * 0.08 * 0.04);
  for (int y = 0; y < truth.things.height; ++y)
    for (int x = 0; x < truth.things.width; ++x) ASSERT_FALSE(truth.things.at(x, y) && truth.skin.at(x, y));
  shown.things.clear();
  EXPECT_TRUE(std::isnan(pixels(shown).row));  // nothing is left of it
}

// r = K / z with K = f R [VisHap 2.1.2].
TEST(StageGeometry, TheOutlinesRadiusFollowsTheDepth) {
  const StageSpec spec = still();
  Stage stage(spec);
  Image left, right;
  PixelTruth truth;
  for (double z = 0.3; z <= 0.9; z += 0.1)
    for (const double x : {-0.1, 0.0, 0.1}) {
      const HandPose hand{{x, 0.02, z}, {0, -1, 0}, 0.0};
      stage.draw(&hand, untapered(), {}, 0, left, right, &truth);
      const double expected = spec.camera.left.focal_x * 0.5 * kWidth / z;
      EXPECT_NEAR(truth.radius, expected, 1.0);
      // And in the picture: across the finger behind its cap, where that is round.
      int wide = 0;
      const int row = static_cast<int>(std::lround(truth.row));
      for (int c = 0; c < 640; ++c) wide += truth.skin.at(c, row) ? 1 : 0;
      if (x != 0.0) continue;
      EXPECT_NEAR(0.5 * wide, expected, 1.0) << z;
    }
}

TEST(StageGeometry, TheMaskAgreesWithTheDepth) {
  Stage stage(still());
  Image left, right;
  PixelTruth truth;
  const HandPose hand{{0.02, -0.02, 0.4}, {0.3, -1, 0.1}, 0.4};
  HandLook look;
  look.bare = 0.4;  // no sleeve in the picture
  stage.draw(&hand, look, {}, 0, left, right, &truth);
  std::int64_t skin = 0;
  for (std::size_t i = 0; i < truth.depth.size(); ++i) {
    EXPECT_EQ(truth.skin.on[i] != 0, truth.depth[i] < 0.7F) << i;
    skin += truth.skin.on[i] != 0 ? 1 : 0;
  }
  EXPECT_GT(static_cast<double>(skin), 0.05 * 640 * 480);
  const auto at = static_cast<std::size_t>(std::lround(truth.row) * 640 + std::lround(truth.column));
  EXPECT_NEAR(static_cast<double>(truth.depth[at]), 0.4 - 0.008, 2e-4);  // the cap's nearest point
  stage.draw(nullptr, look, {}, 0, left, right, &truth);
  for (const std::uint8_t on : truth.skin.on) ASSERT_EQ(on, 0);
  EXPECT_TRUE(std::isnan(truth.radius));
}

}  // namespace
}  // namespace enc::sim
