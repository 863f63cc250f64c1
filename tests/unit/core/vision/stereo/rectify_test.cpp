// Rectification: points of space come to lie in one row, at the disparity of their depth. Pixels are those of
// the raw image; a rectified pair stays as it is; wrong pairs are refused.
#include "core/vision/stereo/rectify.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/vision/stereo/grey.h"
#include "sim/truth/random.h"

namespace enc {
namespace {

StereoRig crooked() {
  StereoRig rig;
  rig.left.distortion = {-0.2, 0.08, 0.0005, -0.0003, 0.01};
  rig.right = {725, 723, 325, 236, {-0.18, 0.07, -0.0004, 0.0002, 0}};
  const Vec3 axis = Vec3(0.2, -0.9, 0.3).normalized();
  rig.X_CD = {Quat(Eigen::AngleAxisd(0.05, axis)), Vec3(0.09, 0.002, -0.003)};
  return rig;
}

Pixel raw_of(const StereoRig& rig, Side side, const Vec3& point) {
  const Vec3 p = side == Side::left ? point : (rig.X_CD.inverse() * Point<'C'>(point)).e();
  return project(side == Side::left ? rig.left : rig.right, {p.x() / p.z(), p.y() / p.z()});
}

TEST(Rectify, APointIsInOneRowAtTheDisparityOfItsDepth) {
  const StereoRig rig = crooked();
  const Rectifier rectifier(rig);
  for (const double z : {0.3, 0.6, 0.9})
    for (const double x : {-0.05, 0.05, 0.12})
      for (const double y : {-0.08, 0.02}) {
        const Vec3 point(x, y, z);
        const Pixel left = rectifier.rectified(Side::left, raw_of(rig, Side::left, point));
        const Pixel right = rectifier.rectified(Side::right, raw_of(rig, Side::right, point));
        EXPECT_NEAR(left.row, right.row, 1e-7);
        const Triplet at{left.column, left.row, left.column - right.column};
        EXPECT_LT((triangulate(rectifier.pair(), at).e() - point).norm(), 1e-10);
        EXPECT_LT((seen_at(rectifier.pair(), Point<'C'>(point)).e() - at.e()).norm(), 1e-7);
      }
}

TEST(Rectify, ThereAndBackIsTheSamePixel) {
  const Rectifier rectifier(crooked());
  for (const Side side : {Side::left, Side::right})
    for (int row = 40; row < 440; row += 57)
      for (int column = 40; column < 600; column += 67) {
        const Pixel back = rectifier.raw(side, rectifier.rectified(side, {column * 1.0, row * 1.0}));
        EXPECT_NEAR(back.column, column, 1e-7);
        EXPECT_NEAR(back.row, row, 1e-7);
      }
}

// The cameras are turned against each other about the baseline by 0.1 rad: each is turned by half of it.
TEST(Rectify, BothCamerasAreTurnedAlike) {
  StereoRig rig;
  rig.X_CD = {Quat(Eigen::AngleAxisd(0.1, Vec3::UnitX())), Vec3(0.09, 0, 0)};
  const Mat3 half = Eigen::AngleAxisd(0.05, Vec3::UnitX()).toRotationMatrix();
  EXPECT_LT((Rectifier(rig).pair().turn - half).norm(), 1e-12);
}

// Waves of 31 px: between pixels a straight line is at most half a level off, and a share rounds to 1/256 px.
double wave(double at) { return 128 + 100 * std::sin(at / 5); }
TEST(Rectify, PixelsComeFromWhereTheMapSays) {
  const StereoRig rig = crooked();
  const Rectifier rectifier(rig);
  Image raw(640, 480), all(640, 480), part(640, 480);
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) {
      raw.at(x, y)[0] = static_cast<std::uint8_t>(wave(x) + 0.5);
      raw.at(x, y)[1] = static_cast<std::uint8_t>(wave(y) + 0.5);
      raw.at(x, y)[2] = 200;
    }
  rectifier.part(Side::right, raw.view(), {-5, -5, 700, 500}, all);
  const Region window{100, 120, 220, 200};
  rectifier.part(Side::right, raw.view(), window, part);
  int inside = 0;
  for (int y = 0; y < 480; y += 7)
    for (int x = 0; x < 640; x += 9) {
      const Pixel from = rectifier.raw(Side::right, {x * 1.0, y * 1.0});
      if (from.column < 1 || from.row < 1 || from.column > 637 || from.row > 477) continue;
      ++inside;
      EXPECT_EQ(all.at(x, y)[2], 200);
      EXPECT_NEAR(all.at(x, y)[0], wave(from.column), 1.7);
      EXPECT_NEAR(all.at(x, y)[1], wave(from.row), 1.7);
    }
  EXPECT_GT(inside, 3000);
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x)
      for (int c = 0; c < 3; ++c) ASSERT_EQ(part.at(x, y)[c], window.contains(x, y) ? all.at(x, y)[c] : 0);
}

TEST(Rectify, APairThatIsAlignedIsTakenAsItIs) {
  EXPECT_TRUE(Rectifier(StereoRig{}).none_needed());
  EXPECT_FALSE(Rectifier(crooked()).none_needed());
  StereoRig turned;
  turned.X_CD = {Quat(Eigen::AngleAxisd(1e-3, Vec3::UnitX())), Vec3(0.09, 0, 0)};
  EXPECT_FALSE(Rectifier(turned).none_needed());
  EXPECT_EQ(Rectifier(StereoRig{}).pair().focal, 721.0);
}

TEST(Rectify, WhatIsNoPairIsRefused) {
  const auto refused = [](const auto& spoil) {
    StereoRig rig;
    spoil(rig);
    EXPECT_THROW(Rectifier{rig}, Error);
  };
  refused([](StereoRig& rig) { rig.width = 0; });
  refused([](StereoRig& rig) { rig.left.focal_x = 0; });
  refused([](StereoRig& rig) { rig.right.distortion[2] = kUnset; });
  refused([](StereoRig& rig) { rig.right.centre_y = std::numeric_limits<double>::infinity(); });
  refused([](StereoRig& rig) { rig.X_CD = {}; });
  refused([](StereoRig& rig) { rig.X_CD = Pose<'C', 'D'>::shift(-0.09, 0, 0); });
  refused([](StereoRig& rig) { rig.X_CD = Pose<'C', 'D'>::shift(0, 0, 0); });
  refused([](StereoRig& rig) { rig.left.distortion[0] = -3.0; });
  refused([](StereoRig& rig) { rig.X_CD = {Quat(Eigen::AngleAxisd(0.6, Vec3::UnitY())), Vec3(0.09, 0, 0)}; });
}

// The lens: by hand, there and back, and the radius at which it folds.

const Lens kBent{700, 710, 320, 240, {-0.25, 0.1, 0.001, -0.002, -0.02}};

// x = 0.3, y = -0.2, r2 = 0.13: radial = 1 - 0.0325 + 0.00169 - 0.00004394 = 0.96914606;
// x'' = 0.290743818 + 2 * 0.001 * -0.06 - 0.002 * (0.13 + 0.18) = 0.290003818,
// y'' = -0.193829212 + 0.001 * (0.13 + 0.08) + 2 * -0.002 * -0.06 = -0.193379212.
TEST(Lens, ProjectsAsWorkedByHand) {
  const Pixel p = project(kBent, {0.3, -0.2});
  EXPECT_NEAR(p.column, 320 + 700 * 0.290003818, 1e-6);
  EXPECT_NEAR(p.row, 240 + 710 * -0.193379212, 1e-6);
}

TEST(Lens, ComesBackFromEveryPixel) {
  for (int row = 0; row < 480; row += 53)
    for (int column = 0; column < 640; column += 61) {
      const Pixel p = project(kBent, ray_of(kBent, {column * 1.0, row * 1.0}));
      EXPECT_NEAR(p.column, column, 1e-8);
      EXPECT_NEAR(p.row, row, 1e-8);
    }
}

TEST(Lens, HasNoRayBeyondItsFold) {
  Lens folds;
  folds.distortion[0] = -1.0;  // r (1 - r^2) has its maximum, 0.385, at r = 0.577
  const double most = folds.focal_x * 0.3849;
  EXPECT_TRUE(std::isfinite(ray_of(folds, {folds.centre_x + 0.99 * most, folds.centre_y}).x));
  EXPECT_FALSE(std::isfinite(ray_of(folds, {folds.centre_x + 1.05 * most, folds.centre_y}).x));
}

constexpr int kColumns = 40, kRows = 30;

Grey noise() {
  Grey image(kColumns, kRows);
  sim::Stream stream(1, "smoothed");
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) *image.at(x, y) = static_cast<std::uint8_t>(stream.bits());
  return image;
}
const Region kWhole{0, 0, kColumns, kRows};

TEST(SmoothGrey, WithoutAPassItIsTheImage) {
  const Grey image = noise();
  const SmoothGrey same(image, kWhole, 0);
  for (int y = 0; y < kRows; ++y)
    for (int x = 0; x < kColumns; ++x) ASSERT_EQ(*same.at(x, y), static_cast<float>(*image.at(x, y)));
}

TEST(SmoothGrey, APointSpreadsByHalfAPixelSquaredAPass) {
  Grey image(kColumns, kRows);
  *image.at(20, 15) = 200;
  for (const int passes : {1, 2, 5}) {
    const SmoothGrey spread(image, kWhole, passes);
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

TEST(SmoothGrey, APixelIsTheSameWhateverElseIsAsked) {
  const Grey image = noise();
  const SmoothGrey all(image, kWhole, 3);
  for (const Region& part : {Region{10, 8, 20, 14}, Region{-5, -5, 4, 3}, Region{35, 20, 60, 50}}) {
    const SmoothGrey some(image, part, 3);
    EXPECT_EQ(some.part(), part.cut(kWhole));
    for (int y = some.part().y0; y < some.part().y1; ++y)
      for (int x = some.part().x0; x < some.part().x1; ++x) ASSERT_EQ(*some.at(x, y), *all.at(x, y));
  }
  EXPECT_TRUE(SmoothGrey(image, Region{50, 0, 60, 10}, 3).part().empty());
}

}  // namespace
}  // namespace enc
