#include "core/shape/surface/surface.h"

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

const Surface kKey{Button{0.016, 0.012, 0.020}};

TEST(Button, OverTheFaceDistanceIsTheHeight) {
  for (const double z : {0.050, 0.003, 0.0, -0.002, -0.019}) {
    const Nearest at = kKey.nearest(Point<'O'>(0.007, -0.0055, z));
    EXPECT_EQ(at.distance, z);
    EXPECT_EQ(at.point.xyz, (std::array<double, 3>{0.007, -0.0055, 0.0}))
        << "never a side, however deep: " << z;
    EXPECT_EQ(at.normal.xyz, (std::array<double, 3>{0, 0, 1}));
    EXPECT_EQ(at.feature, kButtonFace);
  }
}

TEST(Button, BesideItDistanceIsThatToTheEdgeOrTheSide) {
  // 3-4-5: 3 mm beside the edge x = 8 mm and 4 mm above it.
  const Nearest edge = kKey.nearest(Point<'O'>(0.011, 0.001, 0.004));
  EXPECT_NEAR(edge.distance, 0.005, 1e-16);
  EXPECT_NEAR(edge.normal.xyz[0], 0.6, 1e-14);
  EXPECT_NEAR(edge.normal.xyz[2], 0.8, 1e-14);
  EXPECT_EQ(edge.feature, kButtonSide);
  const Nearest side = kKey.nearest(Point<'O'>(0.0, -0.009, -0.010));  // the edge is y = -6 mm
  EXPECT_NEAR(side.distance, 0.003, 1e-16);
  EXPECT_NEAR(side.normal.xyz[1], -1.0, 1e-15);
  EXPECT_EQ(side.point.xyz, (std::array<double, 3>{0.0, -0.006, -0.010}));
  // 2-3-6 of 7: at a corner, above.
  const Nearest corner = kKey.nearest(Point<'O'>(-0.010, 0.009, 0.006));
  EXPECT_NEAR(corner.distance, 0.007, 1e-16);
  EXPECT_NEAR(corner.normal.xyz[0], -2.0 / 7.0, 1e-14);
  const Nearest under = kKey.nearest(Point<'O'>(0.0, 0.0, -0.025));
  EXPECT_NEAR(under.distance, 0.005, 1e-16);
  EXPECT_NEAR(under.normal.xyz[2], -1.0, 1e-15);
}

TEST(Button, OnItsVeryEdgeTheFaceIsNearest) {
  const Nearest edge = kKey.nearest(Point<'O'>(0.008, 0.006, -0.001));
  EXPECT_EQ(edge.feature, kButtonFace);
  EXPECT_EQ(edge.distance, -0.001);
  EXPECT_EQ(kKey.nearest(Point<'O'>(0.008 + 1e-9, 0.0, -0.001)).feature, kButtonSide);
  EXPECT_TRUE(kKey.nearest(Point<'O'>(0.008 + 1e-15, 0.0, -0.001)).normal.finite());
}

TEST(Button, AFingerAtTheRimIsTakenOverTheFace) {
  const Point<'O'> rim = kKey.over_face(Point<'O'>(0.0085, 0.001, -0.002), 0.001);
  EXPECT_EQ(rim.xyz, (std::array<double, 3>{0.008, 0.001, -0.002}));
  EXPECT_EQ(kKey.nearest(rim).distance, -0.002);
  const Point<'O'> clear(0.0095, 0.001, -0.002);
  EXPECT_EQ(kKey.over_face(clear, 0.001).xyz, clear.xyz);
  EXPECT_EQ(Surface{Plane{}}.over_face(clear, 0.001).xyz, clear.xyz);
}

}  // namespace
}  // namespace enc
