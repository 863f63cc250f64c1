#include "core/shape/surface/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "core/shape/surface/mesh.h"
#include "core/shape/surface/mesh_tree.h"
#include "core/shape/surface/triangle.h"
#include "models/shapes/shapes.h"

namespace enc {
namespace {

TEST(Plane, DistanceIsTheHeight) {
  const Surface plane{Plane{}};
  const SurfacePoint above = plane.nearest(Point<'O'>(0.1, -0.2, 0.03));
  EXPECT_EQ(above.distance, 0.03);
  EXPECT_EQ(above.point.xyz, (std::array<double, 3>{0.1, -0.2, 0.0}));
  EXPECT_EQ(above.normal.xyz, (std::array<double, 3>{0, 0, 1}));
  const SurfacePoint below = plane.nearest(Point<'O'>(0, 0, -0.004));
  EXPECT_EQ(below.distance, -0.004);
  EXPECT_EQ(below.normal.xyz[2], 1.0);  // outward, on both sides
}

TEST(Sphere, DistanceIsAlongTheRadius) {
  const Surface ball{Sphere{0.033}};
  // 3-4-5: (0.030, 0, 0.040) is 50 mm from the centre, 17 mm outside; the foot is at 33/50 of it.
  const SurfacePoint outside = ball.nearest(Point<'O'>(0.030, 0, 0.040));
  EXPECT_NEAR(outside.distance, 0.017, 1e-16);
  EXPECT_NEAR(outside.normal.xyz[0], 0.6, 1e-15);
  EXPECT_NEAR(outside.normal.xyz[2], 0.8, 1e-15);
  EXPECT_NEAR(outside.point.xyz[0], 0.0198, 1e-16);
  EXPECT_NEAR(outside.point.xyz[2], 0.0264, 1e-16);
  const SurfacePoint inside = ball.nearest(Point<'O'>(0, -0.011, 0));
  EXPECT_NEAR(inside.distance, -0.022, 1e-16);
  EXPECT_NEAR(inside.normal.xyz[1], -1.0, 1e-15);
}

TEST(Sphere, FromItsCentreTheNearestPointIsTheTop) {
  const SurfacePoint at = Surface{Sphere{0.033}}.nearest(Point<'O'>(0, 0, 0));
  EXPECT_EQ(at.distance, -0.033);
  EXPECT_EQ(at.normal.xyz, (std::array<double, 3>{0, 0, 1}));
  EXPECT_EQ(at.point.xyz, (std::array<double, 3>{0, 0, 0.033}));
}

const Surface kKey{Button{0.016, 0.012, 0.020}};

TEST(Button, OverTheFaceDistanceIsTheHeight) {
  for (const double z : {0.050, 0.003, 0.0, -0.002, -0.019}) {
    const SurfacePoint at = kKey.nearest(Point<'O'>(0.007, -0.0055, z));
    EXPECT_EQ(at.distance, z);
    EXPECT_EQ(at.point.xyz, (std::array<double, 3>{0.007, -0.0055, 0.0}))
        << "never a side, however deep: " << z;
    EXPECT_EQ(at.normal.xyz, (std::array<double, 3>{0, 0, 1}));
    EXPECT_EQ(at.feature, kButtonFace);
  }
}

TEST(Button, BesideItDistanceIsThatToTheEdgeOrTheSide) {
  // 3-4-5: 3 mm beside the edge x = 8 mm and 4 mm above it.
  const SurfacePoint edge = kKey.nearest(Point<'O'>(0.011, 0.001, 0.004));
  EXPECT_NEAR(edge.distance, 0.005, 1e-16);
  EXPECT_NEAR(edge.normal.xyz[0], 0.6, 1e-14);
  EXPECT_NEAR(edge.normal.xyz[2], 0.8, 1e-14);
  EXPECT_EQ(edge.feature, kButtonSide);
  const SurfacePoint side = kKey.nearest(Point<'O'>(0.0, -0.009, -0.010));  // the edge is y = -6 mm
  EXPECT_NEAR(side.distance, 0.003, 1e-16);
  EXPECT_NEAR(side.normal.xyz[1], -1.0, 1e-15);
  EXPECT_EQ(side.point.xyz, (std::array<double, 3>{0.0, -0.006, -0.010}));
  // 2-3-6 of 7: at a corner, above.
  const SurfacePoint corner = kKey.nearest(Point<'O'>(-0.010, 0.009, 0.006));
  EXPECT_NEAR(corner.distance, 0.007, 1e-16);
  EXPECT_NEAR(corner.normal.xyz[0], -2.0 / 7.0, 1e-14);
  const SurfacePoint under = kKey.nearest(Point<'O'>(0.0, 0.0, -0.025));
  EXPECT_NEAR(under.distance, 0.005, 1e-16);
  EXPECT_NEAR(under.normal.xyz[2], -1.0, 1e-15);
}

TEST(Button, OnItsVeryEdgeTheFaceIsNearest) {
  const SurfacePoint edge = kKey.nearest(Point<'O'>(0.008, 0.006, -0.001));
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

void expect_near(const detail::Triple& a, const Vec3& b, double tolerance) {
  EXPECT_LT((a.e() - b).norm(), tolerance) << a.e().transpose() << " is not " << b.transpose();
}

// The corner of a cube of 1 m cut off: three faces on the planes of the axes and one across.
Mesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

TEST(MeshTree, TetrahedronByHand) {
  const MeshTree tree(tetrahedron());
  const double third = 1.0 / 3.0;
  const Vec3 across = Vec3(1, 1, 1).normalized();
  // Over the face across: (1,1,1) is sqrt(3) - 1/sqrt(3) away from x + y + z = 1.
  const SurfacePoint face = tree.nearest(Point<'O'>(1, 1, 1));
  EXPECT_NEAR(face.distance, 2.0 / std::sqrt(3.0), 1e-15);
  expect_near(face.point, Vec3(third, third, third), 1e-15);
  expect_near(face.normal, across, 1e-15);
  EXPECT_EQ(face.feature, 3);
  // Under the floor, inside, and on the face itself.
  EXPECT_DOUBLE_EQ(tree.nearest(Point<'O'>(0.2, 0.3, -0.4)).distance, 0.4);
  const SurfacePoint inside = tree.nearest(Point<'O'>(0.2, 0.3, 0.05));
  EXPECT_DOUBLE_EQ(inside.distance, -0.05);
  EXPECT_EQ(inside.feature, 0);
  expect_near(inside.normal, Vec3(0, 0, -1), 1e-15);
  EXPECT_EQ(tree.nearest(Point<'O'>(0.25, 0.25, 0)).distance, 0.0);
  // Beside the edge on the x axis: between the normals of floor (-z) and wall (-y).
  const SurfacePoint edge = tree.nearest(Point<'O'>(0.5, -0.3, -0.4));
  EXPECT_DOUBLE_EQ(edge.distance, 0.5);
  expect_near(edge.point, Vec3(0.5, 0, 0), 1e-15);
  expect_near(edge.normal, Vec3(0, -1, -1).normalized(), 1e-15);
  EXPECT_EQ(edge.feature, 0);  // floor 0 and wall 1: the lower number
  // Beyond the corner at the origin: three right angles.
  const SurfacePoint corner = tree.nearest(Point<'O'>(-1, -2, -2));
  EXPECT_DOUBLE_EQ(corner.distance, 3.0);
  expect_near(corner.point, Vec3(0, 0, 0), 1e-300);
  expect_near(corner.normal, -across, 1e-15);
  EXPECT_EQ(corner.feature, 0);
  // A point on the corner itself has distance 0 and still a normal.
  const SurfacePoint on = tree.nearest(Point<'O'>(0, 0, 0));
  EXPECT_EQ(on.distance, 0.0);
  expect_near(on.normal, -across, 1e-15);
}

// Angles of the faces at the corner (1,0,0): floor and wall 45 deg, the face across 60 deg. Normals are
// weighted by angle, not by number or area.
TEST(MeshTree, VertexNormalsAreWeightedByAngle) {
  const MeshTree tree(tetrahedron());
  const Vec3 sum = M_PI / 4 * (Vec3(0, 0, -1) + Vec3(0, -1, 0)) + M_PI / 3 * Vec3(1, 1, 1).normalized();
  EXPECT_LT((tree.vertex_normal(1) - sum.normalized()).norm(), 1e-15);
}

// A sharp dent: the nearest point to a p just outside is on an edge, and one of its faces alone would give
// "inside".
TEST(MeshTree, TheSignIsRightWhereASingleFaceIsWrong) {
  // A blade: two faces meet at 10 degrees at the edge from (0,0,-1) to (0,0,1). Beyond the edge p is on the
  // inner side of both planes or of one, so only the sum of the normals decides.
  const double t = std::tan(5.0 * M_PI / 180.0);
  const Mesh blade{{{0, 0, -1}, {0, 0, 1}, {-1, t, 0}, {-1, -t, 0}},
                   {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const MeshTree tree(blade);
  ASSERT_LT(tree.nearest(Point<'O'>(-0.5, 0, 0)).distance, 0.0);
  for (const double y : {-0.9, -0.1, 0.0, 0.1, 0.9}) {
    const SurfacePoint at = tree.nearest(Point<'O'>(0.1, y * 0.01, 0));
    EXPECT_GT(at.distance, 0.0) << y;
    expect_near(at.point, Vec3(0, 0, 0), 1e-15);
    expect_near(at.normal, Vec3(1, 0, 0), 1e-12);
  }
}

TEST(MeshTree, TiesGoToTheLowestTriangleWhateverTheHint) {
  const Mesh cube = models::cube(2, 0.05);
  const MeshTree tree(cube);
  // The centre is equally near to the middles of six faces, and several triangles meet in each.
  const SurfacePoint centre = tree.nearest(Point<'O'>(0, 0, 0));
  EXPECT_DOUBLE_EQ(centre.distance, -0.025);
  std::int32_t lowest = -1;
  for (std::size_t k = 0; k < cube.triangles.size() && lowest < 0; ++k)
    for (const std::int32_t v : cube.triangles[k]) {
      const Vec3 p = Eigen::Map<const Vec3>(cube.vertices[static_cast<std::size_t>(v)].data());
      if (std::abs(p.norm() - 0.025) < 1e-12) lowest = static_cast<std::int32_t>(k);
    }
  EXPECT_EQ(centre.feature, lowest);
  for (std::int32_t hint = -2; hint < static_cast<std::int32_t>(cube.triangles.size()) + 2; ++hint)
    for (const Point<'O'>& p : {Point<'O'>(0, 0, 0), Point<'O'>(0.01, 0.01, 0), Point<'O'>(0.03, 0.03, 0.03),
                                Point<'O'>(0.05, 0, 0.01)}) {
      const SurfacePoint a = tree.nearest(p);
      const SurfacePoint b = tree.nearest(p, hint);
      EXPECT_EQ(a.feature, b.feature);
      EXPECT_EQ(a.distance, b.distance);
      EXPECT_EQ(a.point.xyz, b.point.xyz);
    }
}

TEST(MeshTree, WhatIsNoPlaceHasNoAnswer) {
  const MeshTree tree(tetrahedron());
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double bad : {kUnset, kInfinity, -kInfinity, 1e300, 2e9}) {
    for (const std::int32_t hint : {-1, 0, 3, 1000}) {
      const SurfacePoint at = tree.nearest(Point<'O'>(0.1, bad, 0.1), hint);
      EXPECT_EQ(at.feature, -1);
      EXPECT_TRUE(std::isnan(at.distance));
    }
  }
  EXPECT_NEAR(tree.nearest(Point<'O'>(0, 0, -1e8)).distance, 1e8, 1e-7);
}

TEST(MeshTree, NeighboursMeetAtTheirEdges) {
  const auto across = neighbours_of(tetrahedron());
  const std::vector<std::array<std::int32_t, 3>> by_hand{{2, 3, 1}, {0, 3, 2}, {1, 3, 0}, {0, 2, 1}};
  EXPECT_EQ(across, by_hand);
  for (const auto& mesh :
       {models::geodesic_ball(5), models::cube(3), models::turned_part(), models::knot(60, 12)})
    for (const auto& t : neighbours_of(mesh))
      for (const std::int32_t k : t) EXPECT_GE(k, 0);  // closed
}

// A cone of many sides: all of them meet at its tip, and half of their edges have one end in common.
TEST(MeshTree, NeighboursOfManyFacesAtOneVertex) {
  constexpr std::int32_t kSides = 50'000;
  Mesh cone{{{0, 0, 1}, {0, 0, 0}}, {}};
  for (std::int32_t i = 0; i < kSides; ++i) {
    const double turn = 2.0 * M_PI * i / kSides;
    const std::int32_t a = 2 + i, b = 2 + (i + 1) % kSides;
    cone.vertices.push_back({std::cos(turn), std::sin(turn), 0});
    cone.triangles.push_back({0, a, b});
    cone.triangles.push_back({1, b, a});
  }
  const auto across = neighbours_of(cone);
  for (std::int32_t i = 0; i < kSides; ++i) {
    const std::int32_t next = (i + 1) % kSides, before = (i + kSides - 1) % kSides;
    ASSERT_EQ(across[static_cast<std::size_t>(2 * i)], (std::array{2 * before, 2 * i + 1, 2 * next})) << i;
    ASSERT_EQ(across[static_cast<std::size_t>(2 * i + 1)], (std::array{2 * next + 1, 2 * i, 2 * before + 1}))
        << i;
  }
}

// No file contains such a mesh, as the reader refuses it. The tree returns no point instead of foreign
// memory.
TEST(MeshTree, OfAMeshThatIsTooLargeNothingIsNear) {
  Mesh huge = tetrahedron();
  for (auto& vertex : huge.vertices)
    for (double& x : vertex) x = 2e20 * x - 1e20;
  const SurfacePoint at = MeshTree(huge).nearest(Point<'O'>(0.1, 0.1, 0.1));
  EXPECT_EQ(at.feature, -1);
  EXPECT_TRUE(std::isnan(at.distance) && !at.point.finite() && !at.normal.finite());
}

// Trees of all sizes: partly filled leaves and nodes, one level and several.
TEST(MeshTree, EqualsTryingEveryTriangle) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> coordinate(-0.05, 0.05);
  for (const int n : {1, 2, 3, 4, 5, 7, 12, 20}) {
    const Mesh ball = models::geodesic_ball(n);
    ASSERT_EQ(ball.triangles.size(), 20U * static_cast<std::size_t>(n * n));
    const MeshTree tree(ball);
    for (int i = 0; i < 50; ++i) {
      const Point<'O'> p(coordinate(random), coordinate(random), coordinate(random));
      double least = 1.0;  // m^2
      for (const auto& t : ball.triangles) {
        const auto at = [&](std::size_t k) {
          return Vec3(Eigen::Map<const Vec3>(ball.vertices[static_cast<std::size_t>(t[k])].data()));
        };
        least = std::min(least, nearest_on_triangle(p.e(), {at(0), at(1), at(2)}, t).square);
      }
      const SurfacePoint at = tree.nearest(p);
      EXPECT_NEAR(std::abs(at.distance), std::sqrt(least), 1e-12 * std::sqrt(least) + 1e-17);
      // A ball with flat faces lies inside the round one by no more than the sagitta of its largest triangle,
      // in the middle of an icosahedron's face: ((1.0515 / 0.7947 / sqrt 3) / n)^2 / 2.
      EXPECT_NEAR(at.distance, p.e().norm() - models::kBallRadius, 0.292 * models::kBallRadius / (n * n));
    }
  }
}

TEST(MeshTree, ManyTrianglesInOnePlace) {
  // A needle of zero width: degenerate, but it must not cause a stop or NaN.
  Mesh flat{{{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}}, {}};
  for (int i = 0; i < 100; ++i) flat.triangles.push_back({0, 1, 2});
  const SurfacePoint at = MeshTree(flat).nearest(Point<'O'>(0.25, 0.5, 0));
  EXPECT_DOUBLE_EQ(std::abs(at.distance), 0.5);
  EXPECT_EQ(at.feature, 0);
}

TEST(MeshSurface, IsASurfaceLikeOthers) {
  const Surface surface(MeshSurface{std::make_shared<const MeshTree>(models::geodesic_ball(20))});
  const SurfacePoint at = surface.nearest(Point<'O'>(0, 0, 0.04), 7);
  EXPECT_NEAR(at.distance, 0.007, 3e-5);
  EXPECT_NEAR(surface.bound().radius, models::kBallRadius, 1e-12);
  EXPECT_EQ(surface.nearest(Point<'O'>(0, 0, 0.04)).feature, at.feature);
}

}  // namespace
}  // namespace enc
