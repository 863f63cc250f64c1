// Outlines of an arm's parts against areas that are known.
#include "core/vision/augment/part_mask.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace enc::augment {
namespace {

const RectifiedPair kWidePair{500.0, 319.5, 239.5, 0.1, Mat3::Identity()};
const Pose<'C', 'W'> kSame(Quat::Identity(), Vec3(0, 0, 0));  // W is where C is

double pixels(const ArmPart& part, double margin, Mask* mask = nullptr) {
  Mask own(640, 480);
  Mask& m = mask != nullptr ? *mask : own;
  cover(kWidePair, kSame, part, margin, m);
  return static_cast<double>(std::count(m.on.begin(), m.on.end(), std::uint8_t{255}));
}

TEST(PartMask, ABallIsADiscOfItsOutline) {
  const ArmPart ball{
      PartForm::capsule, Material::metal, Point<'W'>(0, 0, 0.5), Mat3::Identity(), {0.05, 0.05, 0}};
  // Rays touch a ball of r at the distance d where sin is r / d: px of radius f r / sqrt(d^2 - r^2).
  const double r = 500.0 * 0.05 / std::sqrt(0.25 - 0.0025);
  EXPECT_NEAR(pixels(ball, 0.0), M_PI * r * r, 0.02 * M_PI * r * r);
  EXPECT_NEAR(pixels(ball, 5.0), M_PI * (r + 5) * (r + 5), 0.02 * M_PI * (r + 5) * (r + 5));
}

TEST(PartMask, ABoxAndARodAreAsLargeAsTheyAre) {
  const ArmPart plate{
      PartForm::box, Material::plate, Point<'W'>(0.01, 0, 0.5), Mat3::Identity(), {0.04, 0.02, 1e-6}};
  EXPECT_NEAR(pixels(plate, 0.0), 80.0 * 40.0, 130.0);
  EXPECT_NEAR(pixels(plate, 3.0), 86.0 * 46.0, 150.0);
  const Mat3 along_x = Quat::FromTwoVectors(Vec3::UnitZ(), Vec3::UnitX()).toRotationMatrix();
  const ArmPart rod{
      PartForm::cylinder, Material::metal, Point<'W'>(0, 0, 0.5), along_x, {0.004, 0.004, 0.06}};
  EXPECT_NEAR(pixels(rod, 0.0), 120.0 * 8.0, 70.0);
}

TEST(PartMask, WhatIsOutsideOrBehindIsCut) {
  const Mat3 axes = Mat3::Identity();
  EXPECT_EQ(pixels({PartForm::box, Material::plate, Point<'W'>(0, 0, -0.5), axes, {0.1, 0.1, 0.1}}, 3.0),
            0.0);
  EXPECT_EQ(pixels({PartForm::box, Material::plate, Point<'W'>(5, 0, 0.5), axes, {0.1, 0.1, 0.1}}, 3.0), 0.0);
  const double all = pixels({PartForm::box, Material::plate, Point<'W'>(0, 0, 0.5), axes, {9, 9, 0.1}}, 3.0);
  EXPECT_EQ(all, 640.0 * 480.0);
}

}  // namespace
}  // namespace enc::augment
