#include "core/surface.h"

#include <gtest/gtest.h>

namespace enc {
namespace {

TEST(Plane, DistanceIsTheHeight) {
  const Surface plane{Plane{}};
  const Nearest above = plane.nearest(Point<'O'>(0.1, -0.2, 0.03));
  EXPECT_EQ(above.distance, 0.03);
  EXPECT_EQ(above.point.xyz, (std::array<double, 3>{0.1, -0.2, 0.0}));
  EXPECT_EQ(above.normal.xyz, (std::array<double, 3>{0, 0, 1}));
  const Nearest below = plane.nearest(Point<'O'>(0, 0, -0.004));
  EXPECT_EQ(below.distance, -0.004);
  EXPECT_EQ(below.normal.xyz[2], 1.0);  // outward, on both sides
}

TEST(Sphere, DistanceIsAlongTheRadius) {
  const Surface ball{Sphere{0.033}};
  // 3-4-5: (0.030, 0, 0.040) is 50 mm from the centre, 17 mm outside; the foot is at 33/50 of it.
  const Nearest outside = ball.nearest(Point<'O'>(0.030, 0, 0.040));
  EXPECT_NEAR(outside.distance, 0.017, 1e-16);
  EXPECT_NEAR(outside.normal.xyz[0], 0.6, 1e-15);
  EXPECT_NEAR(outside.normal.xyz[2], 0.8, 1e-15);
  EXPECT_NEAR(outside.point.xyz[0], 0.0198, 1e-16);
  EXPECT_NEAR(outside.point.xyz[2], 0.0264, 1e-16);
  const Nearest inside = ball.nearest(Point<'O'>(0, -0.011, 0));
  EXPECT_NEAR(inside.distance, -0.022, 1e-16);
  EXPECT_NEAR(inside.normal.xyz[1], -1.0, 1e-15);
}

TEST(Sphere, FromItsCentreTheNearestPointIsTheTop) {
  const Nearest at = Surface{Sphere{0.033}}.nearest(Point<'O'>(0, 0, 0));
  EXPECT_EQ(at.distance, -0.033);
  EXPECT_EQ(at.normal.xyz, (std::array<double, 3>{0, 0, 1}));
  EXPECT_EQ(at.point.xyz, (std::array<double, 3>{0, 0, 0.033}));
}

}  // namespace
}  // namespace enc
