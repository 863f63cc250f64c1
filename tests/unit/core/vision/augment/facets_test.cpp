// Virtual objects as triangles, and which of them is seen.
#include "core/vision/augment/facets.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace enc::augment {
namespace {

const RectifiedPair kPair{500.0, 159.5, 119.5, 0.1, Mat3::Identity()};

Pose<'C', 'O'> facing(double z) { return {Quat(Eigen::AngleAxisd(M_PI, Vec3::UnitX())), Vec3(0, 0, z)}; }

TEST(Facets, EachShapeIsAsLargeAsItIs) {
  const auto reach = [](const Surface& surface) {
    Vec3 most = Vec3::Zero();
    for (const Point<'O'>& corner : facets_of(surface).corners) most = most.cwiseMax(corner.e().cwiseAbs());
    return most;
  };
  EXPECT_LT((reach(Surface(Plane{})) - Vec3(0.06, 0.06, 0)).norm(), 1e-12);
  EXPECT_LT((reach(Surface(Sphere{0.04})) - Vec3(0.04, 0.04, 0.04)).norm(), 1e-12);
  EXPECT_LT((reach(Surface(Button{0.02, 0.03, 0.05})) - Vec3(0.01, 0.015, 0.05)).norm(), 1e-12);
}

TEST(Facets, TheNearestSurfaceIsSeenAndItsDepthIsExact) {
  Seen seen(320, 240);
  draw(facets_of(Surface(Sphere{0.04})), kPair, facing(0.5), seen);
  draw(facets_of(Surface(Plane{})), kPair, facing(0.5), seen);  // through its middle
  const auto depth = [&](int x, int y) {
    return static_cast<double>(seen.depth[static_cast<std::size_t>(y * 320 + x)]);
  };
  EXPECT_NEAR(depth(160, 120), 0.46, 1e-3);
  EXPECT_NEAR(depth(160 + 55, 120), 0.50, 1e-6);  // beside the ball
  EXPECT_TRUE(std::isinf(depth(160 + 70, 120)));  // and beside the patch
  const auto covered =
      std::count_if(seen.depth.begin(), seen.depth.end(), [](float d) { return std::isfinite(d); });
  EXPECT_NEAR(static_cast<double>(covered), 120.0 * 120.0, 250.0);
}

TEST(Facets, WhatIsNotInFrontIsNotDrawn) {
  Seen seen(320, 240);
  draw(facets_of(Surface(Plane{})), kPair, facing(-0.5), seen);
  draw(facets_of(Surface(Sphere{0.04})), kPair, facing(-0.05), seen);
  for (int i = 0; i < 320 * 240; i += 97) EXPECT_TRUE(std::isinf(seen.depth[static_cast<std::size_t>(i)]));
}

}  // namespace
}  // namespace enc::augment
