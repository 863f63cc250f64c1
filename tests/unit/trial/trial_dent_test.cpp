// The tip of a whole run against a dented surface that knows nothing of dent.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/unit/trial/runs.h"

namespace enc {
namespace {

using test::quick;
using test::run;
using test::scene;
using test::Set;

// The ball dented by the true tool, as a mesh: rings of points around the tool's axis, each pushed radially
// inwards along a raised cosine of the width that a thin ball dimples over, tip radius + sqrt(R depth)
// [sources/ball 2], and further where it would still be inside the tool's tip. It passes through the tool's
// lowest point. Made from the truth and nothing of dent.h.
class DentedBall {
 public:
  DentedBall(const Vec3& centre, double radius, const Vec3& tool, double tool_radius)
      : centre_(centre), radius_(radius) {
    const Vec3 way = tool - centre;
    axis_ = way.normalized();
    depth = std::max(0.0, radius + tool_radius - way.norm());
    x_ = axis_.unitOrthogonal();
    y_ = axis_.cross(x_);
    const double width = tool_radius + std::sqrt(radius * depth);
    for (int ring = 0; ring <= kRings; ++ring)
      for (int i = 0; i < kSectors; ++i) {
        const double angle = kStep * ring;
        const double turn = 2.0 * std::numbers::pi * i / kSectors;
        const Vec3 u =
            std::cos(angle) * axis_ + std::sin(angle) * (std::cos(turn) * x_ + std::sin(turn) * y_);
        const double beside = std::min(1.0, radius * angle / width);
        double at = radius - depth * 0.5 * (1.0 + std::cos(std::numbers::pi * beside));
        // Where the ray enters the tool's sphere, if it does.
        const double along = u.dot(way);
        const double inside = along * along - way.squaredNorm() + tool_radius * tool_radius;
        if (inside > 0.0) at = std::min(at, along - std::sqrt(inside));
        mesh_[static_cast<std::size_t>(ring)][static_cast<std::size_t>(i)] = at * u;
      }
  }

  // Height of a point above the mesh along its own radius; never less than its distance. Beside the mesh:
  // above the ball.
  [[nodiscard]] double height(const Vec3& p) const {
    const Vec3 ray = (p - centre_).normalized();
    const double angle = std::acos(std::clamp(ray.dot(axis_), -1.0, 1.0));
    if (angle >= kStep * kRings) return (p - centre_).norm() - radius_;
    double turn = std::atan2(ray.dot(y_), ray.dot(x_));
    if (turn < 0.0) turn += 2.0 * std::numbers::pi;
    const auto sector = static_cast<int>(turn / (2.0 * std::numbers::pi) * kSectors) % kSectors;
    const auto ring = static_cast<int>(angle / kStep);
    // The flat triangles are chords: a ray near an edge may belong to a neighbour.
    for (int r = std::max(0, ring - 1); r <= std::min(kRings - 1, ring + 1); ++r)
      for (int s = sector - 1; s <= sector + 1; ++s) {
        double at = 0.0;
        if (meets(ray, corner(r, s), corner(r + 1, s), corner(r + 1, s + 1), at) ||
            meets(ray, corner(r, s), corner(r + 1, s + 1), corner(r, s + 1), at))
          return (p - centre_).norm() - at;
      }
    return kUnset;
  }

  double depth = 0.0;

 private:
  static constexpr int kRings = 80, kSectors = 24;
  static constexpr double kStep = 0.2e-3 / 0.033;  // rad: rings 0.2 mm apart, 16 mm in all

  [[nodiscard]] const Vec3& corner(int ring, int sector) const {
    return mesh_[static_cast<std::size_t>(ring)][static_cast<std::size_t>((sector + kSectors) % kSectors)];
  }
  // Ray from the centre through a triangle: at * ray = a + b1 (b - a) + b2 (c - a).
  static bool meets(const Vec3& ray, const Vec3& a, const Vec3& b, const Vec3& c, double& at) {
    Mat3 m;
    m << ray, a - b, a - c;
    const double det = m.determinant();
    if (std::abs(det) < 1e-18) return false;
    const Vec3 x = m.inverse() * a;
    at = x[0];
    constexpr double kEdge = -1e-9;
    return x[1] >= kEdge && x[2] >= kEdge && x[1] + x[2] <= 1.0 - kEdge;
  }

  Vec3 centre_, axis_, x_, y_;
  double radius_;
  std::array<std::array<Vec3, kSectors>, kRings + 1> mesh_;
};

TEST(DentedBall, PassesThroughTheToolsLowestPointAndIsTheBallElsewhere) {
  // A tip of 2 mm whose centre is 31 mm above that of the ball: its lowest point is at 29 mm, 4 mm deep.
  const DentedBall dent(Vec3(0, 0, 0.1), 0.033, Vec3(0, 0, 0.131), 0.002);
  EXPECT_NEAR(dent.depth, 0.004, 1e-12);
  EXPECT_NEAR(dent.height(Vec3(0, 0, 0.129)), 0.0, 1e-9);
  EXPECT_NEAR(dent.height(Vec3(0, 0, 0.133)), 0.004, 1e-9);
  EXPECT_NEAR(dent.height(Vec3(0, -0.033, 0.1)), 0.0, 1e-12);
  // 14 mm along the ball the dent, 2 + sqrt(33 x 4) = 13.5 mm wide, has ended: 14 / 33 rad.
  const double angle = 14.0 / 33.0;
  EXPECT_NEAR(dent.height(Vec3(0.033 * std::sin(angle), 0, 0.1 + 0.033 * std::cos(angle))), 0.0, 30e-6);
  // Half way down the flank it is half as deep, 2 mm: at 6.745 mm / 33 mm rad.
  const double half = 0.5 * (2.0 + std::sqrt(132.0)) / 33.0;
  EXPECT_NEAR(dent.height(Vec3(0.033 * std::sin(half), 0, 0.1 + 0.033 * std::cos(half))), 0.002, 30e-6);
}

struct Margin {
  double worst = -1.0;         // m, height of the tip's outermost point above the mesh
  double worst_excess = -1.0;  // m, above the margin of that tick
  double deepest = 0.0;
  int ticks = 0;
};
// Bound: what the rig states, display.margin + display.margin_speed x age of the surface that the core has
// (0.8 mm + 50 mm/s x 10..50 ms).
Margin margin_of(const Set& set) {
  Margin margin;
  const models::Setup setup = scene("tennis_ball", set);
  trial::TrialOptions options;
  options.watch = [&](const trial::Glance& g) {
    if (g.tick.index % 10 != 0 || g.out.mode != Mode::contact || g.in.dent.health != Health::ok) return;
    const Object& ball = g.scene.objects.front();
    const Vec3 centre = ball.X_WO.p();
    const DentedBall dent(centre, std::get<Sphere>(ball.surface.shape()).radius, g.truth.tool_tip.e(),
                          g.truth.tool_radius);
    const Vec3 tip = g.truth.tip.e();
    const double height = dent.height(tip + g.truth.tip_radius * (tip - centre).normalized());
    ASSERT_TRUE(std::isfinite(height));
    const double bound = g.scene.display.margin + g.scene.display.margin_speed * age(g.tick.t, g.in.dent.t);
    margin.worst = std::max(margin.worst, height);
    margin.worst_excess = std::max(margin.worst_excess, height - bound);
    margin.deepest = std::max(margin.deepest, dent.depth);
    ++margin.ticks;
  };
  EXPECT_TRUE(run(setup, options).holds.empty());
  return margin;
}

TEST(TrialDent, TheTipIsInsideAnIndependentDentedBallWithinTheMargin) {
  const Margin slow = margin_of({"user.approach_mm_s=[20]", "user.press_s=4", "user.release_s=2"});
  EXPECT_GT(slow.ticks, 300);
  EXPECT_GT(slow.deepest, 5.5e-3);
  EXPECT_LE(slow.worst_excess, 0.0);
  EXPECT_LE(slow.worst, 0.8e-3);  // a slow press needs nothing of what age allows
  const Margin fast = margin_of(quick());
  EXPECT_GT(fast.ticks, 100);
  EXPECT_GT(fast.deepest, 3.5e-3);
  EXPECT_LE(fast.worst_excess, 0.0);
  const Margin oblique = margin_of(quick({"user.polar_deg=40", "user.azimuth_deg=30"}));
  EXPECT_GT(oblique.ticks, 100);
  EXPECT_LE(oblique.worst_excess, 0.0);
  RecordProperty("worst_um", static_cast<int>(1e6 * std::max({slow.worst, fast.worst, oblique.worst})));
}

}  // namespace
}  // namespace enc
