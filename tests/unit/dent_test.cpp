#include "core/dent.h"

#include <gtest/gtest.h>

namespace enc {
namespace {

const Surface kBall{Sphere{0.033}};
const Surface kPlane{Plane{}};

TEST(Dent, DepthIsThatOfTheTipsLowestPoint) {
  // Centre 1 mm below a plane, radius 2 mm: the lowest point is 3 mm deep.
  EXPECT_NEAR(dent_of(kPlane, 0, Point<'O'>(0, 0, -0.001), 0.002).depth, 0.003, 1e-15);
  EXPECT_EQ(dent_of(kPlane, 0, Point<'O'>(0, 0, 0.0021), 0.002).depth, 0.0);
  EXPECT_EQ(dent_of(kBall, 3, Point<'O'>(0, 0, 0.05), 0.002).object, 3);
}

TEST(Dent, TheSurfacePassesThroughTheTipsLowestPoint) {
  for (const Surface* surface : {&kBall, &kPlane})
    for (const double depth : {1e-6, 1e-4, 0.001, 0.006}) {
      const double zero = surface == &kBall ? 0.033 : 0.0;
      const Vec3 n = surface == &kBall ? Vec3(Vec3(1, 2, 2) / 3.0) : Vec3(0, 0, 1);
      const DentSample dent = dent_of(*surface, 0, Point<'O'>(Vec3((zero - depth + 0.002) * n)), 0.002);
      EXPECT_NEAR(dent.depth, depth, 1e-15);
      EXPECT_LT(std::abs(dented_distance(*surface, dent, Point<'O'>(Vec3((zero - depth) * n)))), 1e-6)
          << depth;
      // Between dent and undeformed surface one is outside now.
      EXPECT_GT(dented_distance(*surface, dent, Point<'O'>(Vec3((zero - 0.5 * depth) * n))), 0.0);
    }
}

TEST(Dent, FarAwayTheSurfaceIsUndeformed) {
  const DentSample dent =
      dent_of(kBall, 0, Point<'O'>(0, 0, 0.029), 0.002);  // 6 mm deep; reaches 2 + sqrt(33 * 6) = 16 mm
  const Point<'O'> far_side(0, 0.001, -0.030);
  EXPECT_NEAR(dented_distance(kBall, dent, far_side), kBall.nearest(far_side).distance, 1e-7);
}

TEST(Dent, ShallowerAwayFromTheTool) {
  const DentSample dent = dent_of(kPlane, 0, Point<'O'>(0, 0, 0.0), 0.002);
  double before = 1.0;
  for (int i = 0; i < 40; ++i) {
    const double now = dented_distance(kPlane, dent, Point<'O'>(0.0005 * i, 0, 0));
    EXPECT_GE(now, 0.0);
    EXPECT_LT(now, before);
    before = now;
  }
}

TEST(Dent, NoDepthIsNoDent) {
  const DentSample dent = dent_of(kBall, 0, Point<'O'>(0, 0, 0.04), 0.002);
  for (const double z : {0.03, 0.033, 0.04}) {
    const Point<'O'> p(0, 0, z);
    EXPECT_EQ(dented_distance(kBall, dent, p), kBall.nearest(p).distance);
  }
  EXPECT_EQ(dented_distance(kBall, DentSample{}, Point<'O'>(0, 0, 0.04)),
            kBall.nearest(Point<'O'>(0, 0, 0.04)).distance);
}

TEST(Dent, APointToolDentsToo) {
  const DentSample dent = dent_of(kPlane, 0, Point<'O'>(0, 0, -0.003), 0.0);
  EXPECT_NEAR(dent.depth, 0.003, 1e-15);
  EXPECT_NEAR(dented_distance(kPlane, dent, Point<'O'>(0, 0, -0.003)), 0.0, 1e-9);
}

}  // namespace
}  // namespace enc
