// The stereo head by hand: where a point is seen, what is outside, how much a pixel is worth at 0.6 m, which
// noise averaging takes away.
#include "sim/plants/stereo_noise.h"

#include <cmath>

#include <gtest/gtest.h>

namespace enc::sim {
namespace {

CameraTruth exact() {
  CameraTruth truth;
  truth.matching = truth.pointing = truth.standing = truth.disparity_step = 0.0;
  return truth;
}

TEST(StereoNoise, APointByHand) {
  // At 0.721 m a pixel is 1 mm wide and the disparity 0.09 * 721 / 0.721 = 90 px.
  const StereoPoints eyes(CameraTruth{}, 1);
  const auto pixel = eyes.project({0.010, -0.020, 0.721});
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->column, 319.5 + 10.0, 1e-9);
  EXPECT_NEAR(pixel->row, 239.5 - 20.0, 1e-9);
  EXPECT_NEAR(pixel->disparity, 90.0, 1e-9);
  EXPECT_NEAR((eyes.triangulate(*pixel) - Point<'C'>(0.010, -0.020, 0.721)).norm(), 0.0, 1e-12);
}

TEST(StereoNoise, SeesOnlyWhatIsInBothImages) {
  const StereoPoints eyes(CameraTruth{}, 1);
  const double z = 0.721;
  EXPECT_FALSE(eyes.project({0, 0, -z}));
  EXPECT_FALSE(eyes.project({0, 0, 0}));
  EXPECT_FALSE(eyes.project({kUnset, 0, z}));
  EXPECT_TRUE(eyes.project({0.319, 0, z}));
  EXPECT_FALSE(eyes.project({0.320, 0, z}));  // right of the left image
  EXPECT_TRUE(eyes.project({-0.229, 0, z}));  // 229 px left of the middle, and 90 more in the right image
  EXPECT_FALSE(eyes.project({-0.230, 0, z}));
  EXPECT_TRUE(eyes.project({0, 0.239, z}));
  EXPECT_FALSE(eyes.project({0, -0.240, z}));
  StereoPoints seeing(CameraTruth{}, 1);
  EXPECT_FALSE(seeing.see({0, 0, -z}));
}

TEST(StereoNoise, WithoutNoiseTheStepOfTheDisparityIsLeft) {
  StereoPoints without(exact(), 1);
  const Point<'C'> p(0.05, 0.03, 0.6);
  EXPECT_NEAR((*without.see(p) - p).norm(), 0.0, 1e-12);
  CameraTruth truth = exact();
  truth.disparity_step = 1.0 / 16.0;
  StereoPoints stepped(truth, 1);
  for (double z = 0.5; z < 0.7; z += 0.0007) {
    // Half a step, in depth: z^2 / (f b) / 32.
    const double most = z * z / (721.0 * 0.09) / 32.0 * 1.001;
    EXPECT_LE(std::abs(stepped.see({0, 0, z})->e().z() - z), most) << z;
  }
}

// 0.2 px at 0.6 m: 0.36 / 64.89 * 0.2 = 1.11 mm of depth, 0.15 px: 0.125 mm aside.
TEST(StereoNoise, ScattersAsFirstOrderSays) {
  CameraTruth truth;
  truth.standing = 0.0;
  StereoPoints eyes(truth, 7);
  const Point<'C'> p(0.0, 0.1, 0.6);
  const Vec<'C'> theory = eyes.scatter(p);
  EXPECT_NEAR(theory.e().z(), 1.114e-3, 2e-6);
  EXPECT_NEAR(theory.e().x(), 0.125e-3, 1e-6);
  EXPECT_NEAR(theory.e().y(), std::hypot(0.125e-3, 1.114e-3 / 6.0), 2e-6);
  constexpr int kFrames = 20000;
  Vec3 sum = Vec3::Zero(), square = Vec3::Zero();
  for (int i = 0; i < kFrames; ++i) {
    const Vec3 error = (*eyes.see(p) - p).e();
    sum += error / kFrames;
    square += error.cwiseAbs2() / kFrames;
  }
  for (Eigen::Index a = 0; a < 3; ++a) {
    EXPECT_NEAR(std::sqrt(square(a)) / theory.e()(a), 1.0, 0.03) << a;
    EXPECT_LT(std::abs(sum(a)), 4.0 * theory.e()(a) / std::sqrt(kFrames) + 5e-6) << a;
  }
}

TEST(StereoNoise, WhatStandsIsNotAveragedAway) {
  CameraTruth truth = exact();
  truth.standing = 0.05;
  StereoPoints eyes(truth, 3);
  const Point<'C'> p(0.0, 0.0, 0.6);
  const Point<'C'> first = *eyes.see(p);
  EXPECT_GT((first - p).norm(), 1e-6);
  for (int i = 0; i < 10; ++i) EXPECT_EQ((*eyes.see(p) - first).norm(), 0.0);
  eyes.move();
  EXPECT_GT((*eyes.see(p) - first).norm(), 1e-6);
}

TEST(StereoNoise, ASeedRepeats) {
  StereoPoints one(CameraTruth{}, 11), same(CameraTruth{}, 11), other(CameraTruth{}, 12);
  const Point<'C'> p(0.01, 0.02, 0.5), a = *one.see(p);
  EXPECT_EQ(a.xyz, same.see(p)->xyz);
  EXPECT_NE(a.xyz, other.see(p)->xyz);
}

}  // namespace
}  // namespace enc::sim
