// The seen surface for any tip in any pose.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "core/shape/deformation/dent.h"

namespace enc {
namespace {

// How far a point is inside a tip, m; negative outside.
double inside(const Tip<'O'>& tip, const Vec3& p) {
  const Vec3 from = p - tip.centre.e();
  const Vec3 axis = tip.axis.e();
  const double along = from.dot(axis);
  if (tip.shape == TipShape::edge) {
    const double at = std::clamp(along, -0.5 * tip.length, 0.5 * tip.length);
    return tip.radius - (from - at * axis).norm();
  }
  if (tip.shape == TipShape::cone) {
    const double beside = (from - along * axis).norm();
    if (along + beside * std::tan(tip.half_angle) > 0.0)
      return tip.radius + along * std::sin(tip.half_angle) - beside * std::cos(tip.half_angle);
  }
  return tip.radius - from.norm();
}

struct Case {
  std::mt19937_64 random;
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
  Vec3 direction() {
    Vec3 v;
    do v = Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    while (v.norm() > 1.0 || v.norm() < 0.1);
    return v.normalized();
  }
  Tip<'O'> tip(double zero, Vec3& n) {
    n = zero > 0.0 ? direction() : Vec3(0, 0, 1);
    Tip<'O'> tip{Point<'O'>(), uniform(0.0003, 0.010), static_cast<TipShape>(random() % 3)};
    tip.axis = Vec<'O'>(direction());
    if (tip.shape == TipShape::cone) {
      tip.half_angle = uniform(0.1, 1.3);
      const double tilt = uniform(0.0, 1.4 - tip.half_angle);
      tip.axis = Vec<'O'>(Vec3(std::cos(tilt) * n + std::sin(tilt) * n.unitOrthogonal()));
    }
    if (tip.shape == TipShape::edge) tip.length = uniform(0.001, 0.040);
    const double lift = tip.radius - uniform(1e-5, 0.006);
    tip.centre = Point<'O'>(Vec3((zero + lift) * n));
    return tip;
  }
};

void any_pose(const Surface& surface, double zero, std::uint64_t seed) {
  Case pick{std::mt19937_64(seed)};
  double deepest_inside = -1.0;
  int on_tip = 0;
  for (int i = 0; i < 2000; ++i) {
    Vec3 n;
    Tip<'O'> tip = pick.tip(zero, n);
    DentSample dent = dent_of(surface, 0, tip);
    if (dent.depth > 0.010) {  // an edge that leans: lift it
      tip.centre = tip.centre + (dent.depth - 0.004) * Vec<'O'>(n);
      dent = dent_of(surface, 0, tip);
    }
    if (!(dent.depth > 0.0) || dent.depth > 0.010) continue;
    const DentField<double> field = dent_field(surface, dent);
    const Vec3 under = deepest(surface, tip).at.point.e();
    for (int k = 0; k < 40; ++k) {
      const Nearest at = surface.nearest(Point<'O'>(Vec3(under + pick.uniform(0, 0.02) * pick.direction())));
      const Displaced to = displaced(field, at.point, at.normal);
      const double in = inside(tip, to.point.e());
      deepest_inside = std::max(deepest_inside, in);
      on_tip += in > -1e-9 ? 1 : 0;
      ASSERT_GE(to.by, 0.0);
      ASSERT_LE(to.by, dent.depth * (1.0 + 1e-6) + 1e-9)
          << "convex objects: nowhere more than under the tool";
      ASSERT_NEAR(to.normal.norm(), 1.0, 1e-12);
      ASSERT_NEAR(dented_distance(surface, dent, to.point), 0.0, 1e-8);
      const Vec<'O'> up = 20e-6 * Vec<'O'>(Vec3(Vec3::Map(field.n.data())));
      ASSERT_GT(dented_distance(surface, dent, to.point + up), 0.0);
      ASSERT_LT(dented_distance(surface, dent, to.point - up), 0.0);
    }
  }
  EXPECT_LE(deepest_inside, 1e-6);
  EXPECT_GT(on_tip, 1000);
}

TEST(DentProperty, NothingOfABallIsInsideTheTipAndTheSignIsRight) {
  any_pose(Surface(Sphere{0.033}), 0.033, 1);
}
TEST(DentProperty, NothingOfAPlaneIsInsideTheTipAndTheSignIsRight) { any_pose(Surface(Plane{}), 0.0, 2); }

TEST(DentProperty, TheFieldIsContinuousAndTheContactMovesByTheDepth) {
  const Surface ball(Sphere{0.033});
  Case pick{std::mt19937_64(3)};
  for (int i = 0; i < 300; ++i) {
    Vec3 n;
    const Tip<'O'> tip = pick.tip(0.033, n);
    const DentSample dent = dent_of(ball, 0, tip);
    if (!(dent.depth > 0.0) || dent.depth > 0.010) continue;
    const DentField<double> field = dent_field(ball, dent);
    const Nearest contact = deepest(ball, tip).at;
    ASSERT_NEAR(displaced(field, contact.point, contact.normal).by, dent.depth, 1e-9);
    // Away along any great circle: a step of 1 um moves the point by a few at most, the last not at all.
    const Vec3 up = contact.normal.e();
    const Vec3 side = (pick.direction().cross(up)).normalized();
    double before = dent.depth;
    for (int k = 0; k <= 6000; ++k) {
      const double polar = 1e-6 * k * 10 / 0.033;
      const Vec3 out = std::cos(polar) * up + std::sin(polar) * side;
      const double now = displaced(field, Point<'O'>(Vec3(0.033 * out)), Vec<'O'>(out)).by;
      ASSERT_NEAR(now, before, 40e-6) << k;
      before = now;
    }
    if (tip.shape == TipShape::sphere) {
      ASSERT_EQ(before, 0.0);
    }
  }
}

}  // namespace
}  // namespace enc
