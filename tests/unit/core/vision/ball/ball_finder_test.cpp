// A ball before a known stereo head, drawn ray by ray: the finder must find its centre and nothing else.
#include "core/vision/ball/ball_finder.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/spec/vision_check.h"
#include "sim/camera/sensor.h"
#include "sim/truth/random.h"

namespace enc {
namespace {

struct Ball {
  Vec3 at;  // in C, m
  double radius = 0.012;
  Vec3 colour{128, 10, 30};
};
struct Scene {
  std::vector<Ball> balls;
  double light = 1.2;
  // True if something covers the balls along this ray; nothing does by default.
  std::function<bool(const Vec3& ray)> covered = [](const Vec3&) { return false; };
};

StereoRig bent_head() {
  StereoRig rig;
  rig.left.distortion = {-0.20, 0.08, 4e-4, -3e-4, 0.0};
  rig.right.distortion = {-0.21, 0.09, -3e-4, 2e-4, 0.0};
  rig.right.focal_x = rig.right.focal_y = 724.0;
  rig.right.centre_x = 324.0;
  rig.X_CD = {Quat(Eigen::AngleAxisd(0.01, Vec3(0.3, 1.0, 0.2).normalized())), Vec3(0.0901, 0.0006, -0.0004)};
  return rig;
}

// The first hit of a ray from a camera; else the uneven grey of a room.
Vec3 seen(const Scene& scene, const Vec3& from, const Vec3& ray) {
  static const Vec3 kLamp = Vec3(0.2, -0.7, -0.7).normalized();
  if (scene.covered(ray)) return {60, 58, 55};
  double nearest = 1e9;
  Vec3 colour = Vec3(110, 104, 96) * (1.0 + 0.3 * std::sin(23.0 * ray.x()) * std::cos(17.0 * ray.y()));
  for (const Ball& ball : scene.balls) {
    const Vec3 to = ball.at - from;
    const double along = to.dot(ray), aside = to.squaredNorm() - along * along;
    if (aside >= ball.radius * ball.radius) continue;
    const double t = along - std::sqrt(ball.radius * ball.radius - aside);
    if (t >= nearest) continue;
    nearest = t;
    const Vec3 normal = (t * ray - to) / ball.radius;
    colour = scene.light * (0.35 + 0.65 * std::max(0.0, normal.dot(kLamp))) * ball.colour;
  }
  return colour;
}

// Each pixel near a ball is the mean of 6 x 6 rays.
Image drawn(const StereoRig& rig, Side side, const Scene& scene) {
  const bool left = side == Side::left;
  const Lens& lens = left ? rig.left : rig.right;
  const Vec3 from = left ? Vec3(0, 0, 0) : Vec3(rig.X_CD.p());
  const Mat3 turn = left ? Mat3(Mat3::Identity()) : rig.X_CD.q().toRotationMatrix();
  Image image(static_cast<int>(rig.width), static_cast<int>(rig.height));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      bool near = false;
      const auto ray_at = [&](double column, double row) {
        const Ray ray = ray_of(lens, {column, row});
        return Vec3(turn * Vec3(ray.x, ray.y, 1.0).normalized());
      };
      const Vec3 middle = ray_at(x, y);
      for (const Ball& ball : scene.balls) {
        const Vec3 to = ball.at - from;
        near = near || (to.cross(middle)).norm() < ball.radius + 0.006;
      }
      const int n = near ? 6 : 1;
      Vec3 sum = Vec3::Zero();
      for (int i = 0; i < n * n; ++i)
        sum += seen(scene, from,
                    near ? ray_at(x + (i % n + 0.5) / n - 0.5, y + (i / n + 0.5) / n - 0.5) : middle);
      for (int c = 0; c < 3; ++c)
        image.at(x, y)[c] = static_cast<std::uint8_t>(std::clamp(std::round(sum(c) / (n * n)), 0.0, 255.0));
    }
  return image;
}

struct Pair {
  Image left, right;
  [[nodiscard]] StereoFrame frame() const { return {left.view(), right.view()}; }
};
Pair drawn(const StereoRig& rig, const Scene& scene) {
  return {drawn(rig, Side::left, scene), drawn(rig, Side::right, scene)};
}

FoundBall found(const Scene& scene, const StereoRig& rig = {}) {
  BallFinder finder(rig, {});
  const Pair pair = drawn(rig, scene);
  return finder.find(pair.frame());
}

std::vector<Vec3> places() {
  return {{0.03, 0.0, 0.5},   {0.16, 0.12, 0.55}, {-0.1, -0.13, 0.6}, {0.03, 0.02, 0.35}, {0.2, -0.18, 0.8},
          {-0.21, 0.2, 0.85}, {0.08, 0.05, 0.95}, {0.1, -0.05, 0.42}, {-0.03, 0.09, 0.7}, {0.22, 0.03, 0.66}};
}

// ---- the centre
// -----------------------------------------------------------------------------------------------

TEST(BallFinder, FindsTheCentreWithinAFewHundredthsOfAPixelInNoise) {
  const sim::SensorNoise noise(1.5, 7);
  for (const StereoRig& rig : {StereoRig{}, bent_head()}) {
    BallFinder finder(rig, {});
    const RectifiedPair pair = Rectifier(rig).pair();
    for (const Vec3& at : places()) {
      const Pair clean = drawn(rig, {{{at}}});
      const Triplet truth = seen_at(pair, Point<'C'>(at));
      Vec3 mean = Vec3::Zero(), squares = Vec3::Zero();
      constexpr int kFrames = 20;
      for (std::uint64_t frame = 0; frame < kFrames; ++frame) {
        Pair noisy = clean;
        noise.add(noisy.left, frame, 0);
        noise.add(noisy.right, frame, 1);
        const FoundBall ball = finder.find(noisy.frame());
        ASSERT_EQ(ball.loss, BallLoss::none) << at.transpose();
        const Vec3 off = ball.at.e() - truth.e();
        mean += off / kFrames;
        squares += off.cwiseAbs2() / kFrames;
      }
      EXPECT_LT(squares.cwiseSqrt().maxCoeff(), 0.06) << at.transpose() << ": " << mean.transpose();
    }
  }
}

// The middle of the ellipse in the image is not the image of the centre.
TEST(BallFinder, TakesTheCentreAndNotTheMiddleOfTheOutline) {
  const StereoRig rig;
  const Vec3 at(0.115, 0.085, 0.33);
  const FoundBall ball = found({{{at}}});
  ASSERT_EQ(ball.loss, BallLoss::none);
  const Triplet truth = seen_at(Rectifier(rig).pair(), Point<'C'>(at));
  EXPECT_NEAR(ball.at.column, truth.column, 0.06);
  // The outline along the column goes from one tangent ray to the opposite one.
  const double aside = std::atan2(at.x(), std::hypot(at.z(), at.y())), half = std::asin(0.012 / at.norm());
  const double middle = rig.left.centre_x + 0.5 * rig.left.focal_x * std::hypot(at.z(), at.y()) / at.z() *
                                                (std::tan(aside + half) + std::tan(aside - half));
  EXPECT_GT(middle - truth.column, 0.2);
  EXPECT_NEAR(ball.outline[0].sine, 0.012 / at.norm(), 3e-4);
}

// ---- no ball
// ---------------------------------------------------------------------------------------------------

TEST(BallFinder, NothingOfItsColourIsNoBall) {
  EXPECT_EQ(found({}).loss, BallLoss::no_ball);
  EXPECT_EQ(found({{{{0.03, 0.0, 0.5}, 0.012, {60, 160, 40}}}}).loss, BallLoss::no_ball);
  EXPECT_TRUE(std::isnan(found({}).centre.e().x()));
}

TEST(BallFinder, TwoAreNotToldApart) {
  EXPECT_EQ(found({{{{0.03, 0.0, 0.5}}, {{0.10, 0.05, 0.6}}}}).loss, BallLoss::two_balls);
}

TEST(BallFinder, OneThatTheImageCutsIsNotFound) {
  EXPECT_EQ(found({{{{-0.218, 0.0, 0.5}}}}).loss, BallLoss::at_the_edge);        // edge of the left image
  EXPECT_EQ(found({{{{0.09 - 0.218, 0.0, 0.5}}}}).loss, BallLoss::at_the_edge);  // edge of the right one
  EXPECT_EQ(found({{{{0.03, 0.163, 0.5}}}}).loss, BallLoss::at_the_edge);
  EXPECT_EQ(found({{{{-0.24, 0.0, 0.5}}}}).loss, BallLoss::no_ball);
}

TEST(BallFinder, OneThatIsTooBrightHasNoEdgeToTrust) {
  EXPECT_EQ(found({{{{0.03, 0.0, 0.5}}}, 3.0}).loss, BallLoss::too_bright);
}

TEST(BallFinder, OneOfAnotherSizeIsAnotherBall) {
  EXPECT_EQ(found({{{{0.03, 0.0, 0.5}, 0.016}}}).loss, BallLoss::size);
  EXPECT_EQ(found({{{{0.03, 0.0, 0.5}, 0.009}}}).loss, BallLoss::size);
}

TEST(BallFinder, ImagesThatAreSwappedOrOfAnotherSizeHaveNone) {
  const StereoRig rig;
  BallFinder finder(rig, {});
  const Pair pair = drawn(rig, {{{{0.03, 0.0, 0.5}}}});
  EXPECT_EQ(finder.find({pair.right.view(), pair.left.view()}).loss, BallLoss::size);
  const Image small(320, 240);
  EXPECT_EQ(finder.find({pair.left.view(), small.view()}).loss, BallLoss::no_ball);
  EXPECT_EQ(finder.find(pair.frame()).loss, BallLoss::none);
}

// A bar before the left camera hides `share` of the diameter, from its left.
Scene behind_a_bar(double share) {
  Scene scene{{{{0.03, 0.0, 0.5}}}};
  scene.covered = [share](const Vec3& ray) {
    const double x = 0.5 * ray.x() / ray.z() - 0.03;  // m from the ball's centre, at its depth
    return x > -0.03 && x < 0.012 * (2.0 * share - 1.0);
  };
  return scene;
}

TEST(BallFinder, WhatCoversAPartOfItDoesNotPullItAside) {
  const Triplet truth = seen_at(Rectifier(StereoRig{}).pair(), Point<'C'>(0.03, 0.0, 0.5));
  for (const double share : {0.05, 0.1, 0.15}) {
    const FoundBall ball = found(behind_a_bar(share));
    ASSERT_EQ(ball.loss, BallLoss::none) << share;
    EXPECT_LT((ball.at.e() - truth.e()).cwiseAbs().maxCoeff(), 0.1) << share;
  }
  EXPECT_EQ(found(behind_a_bar(0.5)).loss, BallLoss::no_circle);
}

TEST(BallFinder, RefusesImpossibleNumbers) {
  BallSpec spec{.radius = 0.0};
  EXPECT_THROW(BallFinder({}, spec), Error);
  spec = {};
  spec.hue = kUnset;
  EXPECT_THROW(check(spec), Error);
  spec = {};
  spec.least_saturation = 1.5;
  EXPECT_THROW(check(spec), Error);
}

}  // namespace
}  // namespace enc
