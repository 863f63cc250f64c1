#include "core/shape/deformation/dent.h"

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace enc {
namespace {

const Surface kBall{Sphere{0.033}};
const Surface kPlane{Plane{}};

Tip<'O'> ball_tip(const Vec3& centre, double radius) { return {Point<'O'>(centre), radius}; }
Tip<'O'> cone_tip(const Vec3& centre, double radius, double half_angle, const Vec3& axis) {
  return {Point<'O'>(centre), radius, TipShape::cone, Vec<'O'>(Vec3(axis.normalized())), half_angle};
}
Tip<'O'> edge_tip(const Vec3& centre, double radius, double length, const Vec3& axis) {
  return {Point<'O'>(centre), radius, TipShape::edge, Vec<'O'>(Vec3(axis.normalized())), 0.0, length};
}
DisplacedPoint moved(const Surface& surface, const DentSample& dent, const Vec3& p) {
  const SurfacePoint at = surface.nearest(Point<'O'>(p));
  return displaced(dent_field(surface, dent), at.point, at.normal);
}

TEST(Dent, DepthIsThatOfTheTipsLowestPoint) {
  // Centre 1 mm below a plane, radius 2 mm: the lowest point is 3 mm deep.
  EXPECT_NEAR(dent_of(kPlane, 0, ball_tip({0, 0, -0.001}, 0.002)).depth, 0.003, 1e-15);
  EXPECT_EQ(dent_of(kPlane, 0, ball_tip({0, 0, 0.0021}, 0.002)).depth, 0.0);
  EXPECT_EQ(dent_of(kBall, 3, ball_tip({0, 0, 0.05}, 0.002)).object, 3);
  // An edge of 40 mm whose middle is 1 mm above the plane, 30 degrees down: its end is 10 mm lower.
  const Tip<'O'> tilted = edge_tip({0, 0, 0.001}, 0.002, 0.040, {std::cos(M_PI / 6), 0, -0.5});
  EXPECT_NEAR(dent_of(kPlane, 0, tilted).depth, 0.011, 1e-12);
  EXPECT_NEAR(deepest(kPlane, tilted).centre.xyz[0], 0.020 * std::cos(M_PI / 6), 1e-12);
  // On a ball an edge touches where it is nearest to the centre, here 5 mm from its middle.
  const Tip<'O'> across = edge_tip({0.005, 0, 0.034}, 0.002, 0.040, {1, 0, 0});
  EXPECT_NEAR(dent_of(kBall, 0, across).depth, 0.001, 1e-12);
  EXPECT_NEAR(deepest(kBall, across).centre.xyz[0], 0.0, 1e-8);
}

TEST(Dent, ThePointUnderTheToolMovesByTheDepth) {
  for (const Surface* surface : {&kBall, &kPlane})
    for (const double depth : {1e-6, 1e-4, 0.001, 0.002, 0.004, 0.006})
      for (const double radius : {0.0, 0.002, 0.010}) {
        const double zero = surface == &kBall ? 0.033 : 0.0;
        const Vec3 n = surface == &kBall ? Vec3(Vec3(1, 2, 2) / 3.0) : Vec3(0, 0, 1);
        const Vec3 centre = (zero - depth + radius) * n;
        for (const Tip<'O'>& tip :
             {ball_tip(centre, radius), cone_tip(centre, radius, 0.5, n + Vec3(0.2, 0, 0)),
              edge_tip(centre, radius, 0.03, n.unitOrthogonal())}) {
          const DentSample dent = dent_of(*surface, 0, tip);
          EXPECT_NEAR(dent.depth, depth, 1e-14);
          const DisplacedPoint under = moved(*surface, dent, zero * n);
          EXPECT_NEAR(under.by, depth, 1e-12);
          EXPECT_LT((under.point.e() - (zero - depth) * n).norm(), 1e-12);
          EXPECT_GT(under.normal.e().dot(n), 1.0 - 1e-9);
          EXPECT_NEAR(dented_distance(*surface, dent, under.point), 0.0, 1e-9);
          // A point between dent and undeformed surface is outside now; a point under the dent is inside.
          EXPECT_NEAR(dented_distance(*surface, dent, Point<'O'>(Vec3((zero - 0.5 * depth) * n))),
                      0.5 * depth, 1e-9);
          EXPECT_NEAR(dented_distance(*surface, dent, Point<'O'>(Vec3((zero - 1.5 * depth) * n))),
                      -0.5 * depth, 1e-9);
        }
      }
}

TEST(Dent, TheSurfaceLiesOnTheTip) {
  // 4 mm deep in the ball it leaves the tip at a slope of 2 sqrt(4/33) = 0.696, 34.8 degrees: 1.14 mm from
  // the axis of a ball of 2 mm.
  const Vec3 centre(0, 0, 0.033 - 0.004 + 0.002);
  const DentSample dent = dent_of(kBall, 0, ball_tip(centre, 0.002));
  for (const double aside : {0.0, 0.3e-3, 0.8e-3, 1.13e-3}) {
    const DisplacedPoint at = moved(kBall, dent, {aside, 0, std::sqrt(0.033 * 0.033 - aside * aside)});
    EXPECT_NEAR((at.point.e() - centre).norm(), 0.002, 1e-12) << aside;
    EXPECT_LT((at.normal.e() - (centre - at.point.e()) / 0.002).norm(), 1e-9) << aside;
  }
  const DisplacedPoint beyond = moved(kBall, dent, {2e-3, 0, std::sqrt(0.033 * 0.033 - 4e-6)});
  EXPECT_GT((beyond.point.e() - centre).norm(), 0.002 + 1e-4);
  // A blunt cone of 75 degrees rises by cot 75 = 0.268 beside its apex: the surface lies on its side.
  const DentSample blunt = dent_of(kBall, 0, cone_tip(centre, 0.002, 75 * M_PI / 180, {0, 0, 1}));
  for (const double aside : {1e-3, 2e-3, 3e-3}) {
    const DisplacedPoint at = moved(kBall, blunt, {0, aside, std::sqrt(0.033 * 0.033 - aside * aside)});
    const double side =
        (at.point.xyz[2] - centre.z()) * std::sin(75 * M_PI / 180) - aside * std::cos(75 * M_PI / 180);
    EXPECT_NEAR(side, -0.002, 1e-12) << aside;
  }
  // The surface lies on the whole edge of 10 mm that is 4 mm deep in a plane.
  const DentSample edge = dent_of(kPlane, 0, edge_tip({0, 0, -0.002}, 0.002, 0.010, {0, 1, 0}));
  for (const double along : {-5e-3, 0.0, 3e-3, 5e-3})
    EXPECT_NEAR(moved(kPlane, edge, {0, along, 0}).by, 0.004, 1e-12) << along;
  EXPECT_LT(moved(kPlane, edge, {0, 8e-3, 0}).by, 0.003);
  EXPECT_LT(moved(kPlane, edge, {3e-3, 0, 0}).by, 0.003);
}

TEST(Dent, TheBallSinksAroundTheTip) {
  // A point of 0.2 mm, 3 mm deep: the ball sinks by s = d^2 / (d + 0.116 R) = 1.3182 mm, seen up to 0.8 R =
  // 26.4 mm from the contact, where a chord of that length is 24.20 mm from the axis.
  const DentSample dent = dent_of(kBall, 0, ball_tip({0, 0, 0.030}, 0.0));
  const auto by = [&](double aside) {
    return moved(kBall, dent, {aside, 0, std::sqrt(0.033 * 0.033 - aside * aside)}).by;
  };
  EXPECT_GT(by(24.1e-3), 0.0);
  EXPECT_EQ(by(24.3e-3), 0.0);
  // 15 mm from the axis, out of the tip's reach: 15.43 mm from the contact.
  const double chord2 = 2 * 0.033 * (0.033 - std::sqrt(0.033 * 0.033 - 0.015 * 0.015));
  EXPECT_NEAR(by(15e-3), 9e-6 / 6.828e-3 * std::pow(1.0 - chord2 / (0.0264 * 0.0264), 3), 1e-12);
  double before = 1.0;
  for (int i = 0; i < 242; ++i) {
    const double now = by(1e-4 * i);
    EXPECT_LT(now, before);
    before = now;
  }
  for (const double z : {-0.033, -0.02, 0.0})
    EXPECT_EQ(moved(kBall, dent, {std::sqrt(0.033 * 0.033 - z * z), 0, z}).by, 0.0);
}

TEST(Dent, EndsAfterThreeDepthsAndAThirdOnAPlane) {
  const DentSample dent = dent_of(kPlane, 0, ball_tip({0, 0, -0.003}, 0.0));
  EXPECT_GT(moved(kPlane, dent, {9.8e-3, 0, 0}).by, 0.0);
  EXPECT_EQ(moved(kPlane, dent, {10.2e-3, 0, 0}).by, 0.0);
}

// Tips in all their poses, each with a dent.
std::vector<DentSample> dents(const Surface& surface) {
  const double zero = &surface == &kBall ? 0.033 : 0.0;
  const Vec3 centre(0, 0, zero - 0.002);
  std::vector<Tip<'O'>> tips{ball_tip(centre, 0.002), ball_tip(centre + Vec3(0, 0, 0.008), 0.010),
                             cone_tip(centre, 0.001, 1.25, {0.1, 0, 1}),
                             edge_tip(centre, 0.001, 0.012, {1, 0.3, 0}),
                             edge_tip(centre, 0.001, 0.012, {1, 0.3, 0.2})};
  std::vector<DentSample> all;
  for (const Tip<'O'>& tip : tips) all.push_back(dent_of(surface, 0, tip));
  return all;
}
Vec3 on(const Surface& surface, double x, double y) {
  return {x, y, &surface == &kBall ? std::sqrt(0.033 * 0.033 - x * x - y * y) : 0.0};
}

TEST(Dent, NormalsAreThoseOfTheDisplacedSurface) {
  constexpr double kStep = 1e-7;
  for (const Surface* surface : {&kBall, &kPlane})
    for (const DentSample& dent : dents(*surface))
      for (int i = 0; i < 400; ++i) {
        const double x = 0.8e-3 * (i % 20 - 10) + 0.13e-3;
        const double y = 0.8e-3 * (i / 20 - 10) + 0.21e-3;
        const auto to = [&](double dx, double dy) {
          return Vec3(moved(*surface, dent, on(*surface, x + dx, y + dy)).point.e());
        };
        const Vec3 n = (to(kStep, 0) - to(-kStep, 0)).cross(to(0, kStep) - to(0, -kStep)).normalized();
        EXPECT_LT((n - moved(*surface, dent, on(*surface, x, y)).normal.e()).norm(), 2e-3) << x << " " << y;
      }
}

TEST(Dent, NormalsHaveNoJump) {
  // A normal turns at most by step / smallest radius of curvature, here 0.5 mm: 4e-4 for 0.2 um.
  for (const Surface* surface : {&kBall, &kPlane})
    for (const DentSample& dent : dents(*surface))
      for (const double direction : {0.0, 0.7, 2.0, 4.0}) {
        Vec3 before = Vec3::Zero();
        for (int i = 0; i < 100'000; ++i) {
          const double aside = 0.2e-6 * i;
          const Vec3 n = moved(*surface, dent,
                               on(*surface, aside * std::cos(direction), 1e-4 + aside * std::sin(direction)))
                             .normal.e();
          if (i > 0) {
            ASSERT_LT((n - before).norm(), 4e-4) << aside << " towards " << direction;
          }
          before = n;
        }
      }
}

TEST(Dent, ArraysAreDisplacedAsPointsAre) {
  for (const Surface* surface : {&kBall, &kPlane})
    for (const DentSample& dent : dents(*surface)) {
      const DentField<double> field = dent_field(*surface, dent);
      std::array<std::vector<float>, 6> in;
      for (int i = 0; i < 1003; ++i) {  // not a multiple of anything
        const Vec3 p = on(*surface, 1e-3 * (i % 33 - 16), 1e-3 * (i / 33 - 15));
        const Vec3 n = surface->nearest(Point<'O'>(p)).normal.e();
        for (std::size_t k = 0; k < 3; ++k) {
          in[k].push_back(static_cast<float>(p[static_cast<int>(k)]));
          in[k + 3].push_back(static_cast<float>(n[static_cast<int>(k)]));
        }
      }
      auto out = in;
      apply(to_float(field),
            {in[0].data(), in[1].data(), in[2].data(), in[3].data(), in[4].data(), in[5].data()},
            {out[0].data(), out[1].data(), out[2].data(), out[3].data(), out[4].data(), out[5].data()}, 1003);
      for (std::size_t i = 0; i < 1003; ++i) {
        const DisplacedPoint one = displaced(field, Point<'O'>(in[0][i], in[1][i], in[2][i]),
                                             Vec<'O'>(in[3][i], in[4][i], in[5][i]));
        EXPECT_LT((one.point.e() - Vec3(out[0][i], out[1][i], out[2][i])).norm(), 2e-8);
        EXPECT_LT((one.normal.e() - Vec3(out[3][i], out[4][i], out[5][i])).norm(), 2e-4);
        if (one.by == 0.0) {
          EXPECT_EQ(in[0][i], out[0][i]);
          EXPECT_EQ(in[5][i], out[5][i]);
        }
      }
    }
}

TEST(Dent, VolumeOfADentInAPlate) {
  // A square of 40 mm in the plane z = 0 closed by a point 10 mm below; the volume over the plate is the
  // integral of the displacement, here summed over the squares of a grid.
  constexpr int kSide = 80;
  Mesh mesh;
  for (int i = 0; i <= kSide; ++i)
    for (int j = 0; j <= kSide; ++j) mesh.vertices.push_back({0.5e-3 * i - 0.020, 0.5e-3 * j - 0.020, 0.0});
  const auto at = [](int i, int j) { return i * (kSide + 1) + j; };
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  const DentSample dent = dent_of(kPlane, 0, ball_tip({0, 0, -0.001}, 0.002));
  double sum = 0.0;
  for (const auto& v : mesh.vertices) sum += moved(kPlane, dent, {v[0], v[1], v[2]}).by * 0.25e-6;
  EXPECT_GT(sum, 1e-8);
  EXPECT_NEAR(volume_change(mesh, dent_field(kPlane, dent)), -sum, 1e-3 * sum);
  EXPECT_EQ(volume_change(mesh, DentField<double>{}), 0.0);
}

TEST(Dent, NoDepthIsNoDent) {
  const DentSample dent = dent_of(kBall, 0, ball_tip({0, 0, 0.04}, 0.002));
  for (const double z : {0.03, 0.033, 0.04}) {
    const Point<'O'> p(0, 0, z);
    EXPECT_EQ(dented_distance(kBall, dent, p), kBall.nearest(p).distance);
    EXPECT_EQ(moved(kBall, dent, p.e()).by, 0.0);
  }
  EXPECT_EQ(dented_distance(kBall, DentSample{}, Point<'O'>(0, 0, 0.04)),
            kBall.nearest(Point<'O'>(0, 0, 0.04)).distance);
}

TEST(Dent, FarAwayTheSurfaceIsUndeformed) {
  const DentSample dent = dent_of(kBall, 0, ball_tip({0, 0, 0.029}, 0.002));
  for (const Point<'O'> far :
       {Point<'O'>(0, 0.001, -0.030), Point<'O'>(0.033, 0, 0), Point<'O'>(0, 0, -0.05)})
    EXPECT_EQ(dented_distance(kBall, dent, far), kBall.nearest(far).distance);
}

}  // namespace
}  // namespace enc
