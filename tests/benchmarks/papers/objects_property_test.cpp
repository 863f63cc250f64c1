// Seeded properties of the objects that a finger touches: buttons against an oracle, and the choice of the
// nearest of many objects.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "benchmarks/switching/crowd.h"
#include "core/control/world/object.h"
#include "tests/support/scenes.h"

namespace enc {
namespace {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double even(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  double bell(double sigma) { return std::normal_distribution<double>(0.0, sigma)(engine_); }
  Vec3 in_cube(double half) { return {even(-half, half), even(-half, half), even(-half, half)}; }

 private:
  std::mt19937_64 engine_;
};

// Computes the nearest point of a triangle from its three edges and its inside, one after another. It shares
// no code with Button.
Vec3 on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  return a + std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0) * (b - a);
}
double to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  double least = std::min(
      {(p - on_segment(p, a, b)).norm(), (p - on_segment(p, b, c)).norm(), (p - on_segment(p, c, a)).norm()});
  const Vec3 n = (b - a).cross(c - a).normalized();
  const Vec3 foot = p - n.dot(p - a) * n;
  const auto left = [&](const Vec3& from, const Vec3& to) {
    return (to - from).cross(foot - from).dot(n) >= 0.0;
  };
  if (left(a, b) && left(b, c) && left(c, a)) least = std::min(least, (p - foot).norm());
  return least;
}
// Distance to the nearest of the box's twelve triangles.
double to_box(const Vec3& p, const Button& b) {
  const auto corner = [&](int i) {
    return Vec3((i & 1) != 0 ? 0.5 * b.width : -0.5 * b.width,
                (i & 2) != 0 ? 0.5 * b.height : -0.5 * b.height, (i & 4) != 0 ? 0.0 : -b.thickness);
  };
  constexpr int kFaces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  double least = INFINITY;
  for (const auto& f : kFaces)
    least = std::min({least, to_triangle(p, corner(f[0]), corner(f[1]), corner(f[2])),
                      to_triangle(p, corner(f[0]), corner(f[2]), corner(f[3]))});
  return least;
}

TEST(ButtonProperty, DistancesAreThoseOfABoxAndInsideThoseToItsFace) {
  Random random(1);
  int inside = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Button button{random.even(0.002, 0.05), random.even(0.002, 0.05), random.even(0.002, 0.05)};
    const Surface surface{button};
    const Vec3 p = random.in_cube(0.06);
    const SurfacePoint at = surface.nearest(Point<'O'>(p));
    const bool over = std::abs(p.x()) <= 0.5 * button.width && std::abs(p.y()) <= 0.5 * button.height;
    const bool face = over && p.z() >= -button.thickness;
    inside += face && p.z() < 0.0 ? 1 : 0;
    ASSERT_EQ(at.feature, face ? kButtonFace : kButtonSide);
    ASSERT_NEAR(at.distance, face ? p.z() : to_box(p, button), 1e-12);
    ASSERT_NEAR(at.normal.norm(), 1.0, 1e-12);
    ASSERT_NEAR((at.point + at.distance * at.normal - Point<'O'>(p)).norm(), 0.0, 1e-12);
    const Ball ball = surface.bound();
    ASSERT_GE(at.distance, (Point<'O'>(p) - ball.centre).norm() - ball.radius - 1e-12) << "its ball holds it";
  }
  EXPECT_GT(inside, 100);
}

// A point 1e-9 m on either side of an edge belongs to the correct side.
TEST(ButtonProperty, EdgesAreExact) {
  Random random(2);
  for (int i = 0; i < 10'000; ++i) {
    const Button button{random.even(0.002, 0.05), random.even(0.002, 0.05), 0.02};
    const double off = i % 2 == 0 ? 1e-9 : -1e-9;
    const double y = random.even(-0.4, 0.4) * button.height, z = random.even(-0.01, 0.01);
    const SurfacePoint at = Surface{button}.nearest(Point<'O'>(0.5 * button.width + off, y, z));
    ASSERT_EQ(at.feature, off > 0 ? kButtonSide : kButtonFace);
    ASSERT_NEAR(at.point.xyz[0], 0.5 * button.width + std::min(off, 0.0), 1e-15);
  }
}

Scene crowded(std::size_t count, std::uint64_t seed) {
  Scene scene = prepare(test::ball_scene(), test::exact_rig());
  bench::switching::fill_with_crowd(scene, count, seed);
  return scene;
}

bool is_button(const Scene& scene, std::int32_t index) {
  return std::holds_alternative<Button>(scene.objects[static_cast<std::size_t>(index)].surface.shape());
}

// Without a previous object the choice is the nearest one, whatever the bounds exclude.
TEST(NearestObject, IsTheRightOneInAllQueries) {
  Random random(3);
  test::Loop loop(crowded(50, 7));
  int near = 0;
  for (int i = 0; i < 10'000; ++i) {
    loop.state = State{};
    loop.tool_tip = Point<'W'>(random.in_cube(bench::switching::kCrowdRoom));
    loop.tick();
    const bench::switching::NearestObject right = bench::switching::brute_force(loop.scene, loop.tool_tip);
    ASSERT_EQ(loop.out.object, right.object) << i;
    // Beside a button the gap is the distance to its edge.
    const bool beside =
        loop.state.hints.tool[0].feature == kButtonSide && is_button(loop.scene, right.object);
    ASSERT_NEAR(loop.out.gap, right.distance - (beside ? 0.0 : test::kToolRadius), 1e-12);
    near += right.next - right.distance < 1e-3 ? 1 : 0;
  }
  EXPECT_GT(near, 100) << "some were close decisions";
}

// The tracker is exact, because prediction would smooth the noise away.
int switches(Scene scene, double hysteresis, const Point<'W'>& middle, double noise, int ticks) {
  scene.follow.hysteresis = hysteresis;
  test::Loop loop(std::move(scene));
  Random random(4);
  int count = 0;
  std::int32_t before = -1;
  for (int i = 0; i < ticks; ++i) {
    loop.tool_tip = middle + Vec<'W'>(random.bell(noise), random.bell(noise), random.bell(noise));
    loop.tick();
    count += before >= 0 && loop.out.object != before ? 1 : 0;
    before = loop.out.object;
  }
  return count;
}

Scene two_balls(double apart) {
  Scene scene = prepare(test::ball_scene(), test::exact_rig());
  const Surface ball{Sphere{0.010}};
  scene.objects = {Object{ball, Pose<'W', 'O'>::shift(-0.5 * apart, 0, 0.02), {}},
                   Object{ball, Pose<'W', 'O'>::shift(0.5 * apart, 0, 0.02), {}}};
  return scene;
}

// Between two objects that face each other, 1 mm of noise (one sigma, each axis) is 2 mm in the difference of
// their distances; the hysteresis of room.toml is six sigma of that.
TEST(NearestObject, DoesNotFlickerOnTheMidLine) {
  const Point<'W'> middle(0, 0, 0.02);
  EXPECT_EQ(switches(two_balls(0.08), 0.012, middle, 1e-3, 60'000), 0);
  EXPECT_GT(switches(two_balls(0.08), 0.001, middle, 1e-3, 60'000), 1000) << "what it is good for";
}

TEST(NearestObject, OfTwoThatCoincideTheFirstIsTaken) {
  Random random(5);
  Scene scene = two_balls(0.0);
  test::Loop loop(std::move(scene));
  for (int i = 0; i < 1000; ++i) {
    loop.tool_tip = Point<'W'>(random.in_cube(0.05));
    if (i % 100 == 0) loop.state = State{};
    loop.tick();
    ASSERT_EQ(loop.out.object, 0);
  }
}

// An arm renders the touched object at once: the hysteresis for the previous nearest object does not delay
// it.
TEST(NearestObject, WhatAnArmsFingerTouchesTakesOverAtOnce) {
  for (const bool has_arm : {false, true}) {
    Scene scene = two_balls(0.036);  // 16 mm between them, and a tip of 2 mm
    if (has_arm) scene.task = ImpedanceTask();
    scene.follow.hysteresis = 0.015;
    test::Loop loop(std::move(scene));
    loop.tool_tip = {-0.004, 0, 0.02};
    loop.tick();
    ASSERT_EQ(loop.out.object, 0);
    loop.tool_tip = {0.0055, 0, 0.02};  // 2.5 mm from the second ball: not touched
    loop.tick();
    EXPECT_EQ(loop.out.object, 0);
    loop.tool_tip = {0.0065, 0, 0.02};
    loop.tick();
    EXPECT_EQ(loop.out.object, has_arm ? 1 : 0);
  }
}

}  // namespace
}  // namespace enc
