// Registration on seeded random sets: known transforms come back, the least error is the least, and noise
// does to other points what theory says it does.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/rotation.h"
#include "models/identify/camera/register.h"
#include "sim/truth/random.h"

namespace enc {
namespace {

using sim::Stream;

Quat any_rotation(Stream& random) {
  const Vec3 v = random.normal3();
  return Quat(random.normal(), v.x(), v.y(), v.z()).normalized();
}
Pose<'W', 'C'> any_pose(Stream& random) { return {any_rotation(random), Vec3(random.normal3())}; }

std::vector<Vec3> any_points(Stream& random, std::size_t count, const Vec3& size) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < count; ++i) points.emplace_back(random.normal3().cwiseProduct(size));
  return points;
}
std::vector<models::PointPair> pairs_of(const std::vector<Vec3>& camera, const Pose<'W', 'C'>& X_WC) {
  std::vector<models::PointPair> pairs;
  for (const Vec3& c : camera) pairs.push_back({Point<'C'>(c), X_WC * Point<'C'>(c)});
  return pairs;
}

TEST(RegisterProperty, RecoversKnownTransforms) {
  Stream random(1, "register");
  for (int i = 0; i < 5000; ++i) {
    const Pose<'W', 'C'> truth = any_pose(random);
    // Round, flat (a plane) and long sets, up to a length of 50 times their width.
    const double flat = i % 4 == 0 ? 0.0 : std::exp(-3.9 * random.uniform());
    const double narrow = std::exp(-3.9 * random.uniform());
    const Vec3 size = 0.1 * Vec3(1.0, narrow, flat);
    const auto points = any_points(random, 4 + static_cast<std::size_t>(random.bits() % 17), size);
    models::Registration found;
    try {
      found = models::register_points(pairs_of(points, truth));
    } catch (const std::exception&) {
      continue;  // four random points may lie on a line; how often is counted below
    }
    ASSERT_LT((found.X_WC.p() - truth.p()).norm(), 1e-9) << i;
    ASSERT_LT(found.X_WC.q().angularDistance(truth.q()), 1e-7) << i;  // acos is blunt near 1
    ASSERT_LT((found.X_WC.q().toRotationMatrix() - truth.q().toRotationMatrix()).norm(), 1e-9) << i;
    ASSERT_LT(found.rms, 1e-12) << i;
    ASSERT_GE(found.condition, 1.0) << i;
  }
}

TEST(RegisterProperty, HardlyAnySetIsRefused) {
  Stream random(2, "register");
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto points = any_points(random, 4, Vec3(0.1, 0.1, 0.1));
    try {
      (void)models::register_points(pairs_of(points, any_pose(random)));
    } catch (const std::exception&) {
      ++refused;
    }
  }
  EXPECT_EQ(refused, 0);
}

TEST(RegisterProperty, NoOtherPoseLeavesLess) {
  Stream random(3, "register");
  const auto sum = [](const std::vector<models::PointPair>& pairs, const Pose<'W', 'C'>& X_WC) {
    double squares = 0.0;
    for (const models::PointPair& p : pairs) squares += (X_WC * p.camera - p.device).e().squaredNorm();
    return squares;
  };
  for (int i = 0; i < 300; ++i) {
    auto pairs = pairs_of(any_points(random, 8, Vec3(0.1, 0.05, 0.03)), any_pose(random));
    for (models::PointPair& p : pairs) p.device = p.device + Vec<'W'>(Vec3(0.02 * random.normal3()));
    const models::Registration found = models::register_points(pairs);
    const double least = sum(pairs, found.X_WC);
    EXPECT_NEAR(found.rms, std::sqrt(least / 8.0), 1e-12);
    for (const double size : {1e-4, 1e-2, 1.0})
      for (int k = 0; k < 10; ++k) {
        const Pose<'W', 'W'> off(rotation_xyz(size * random.normal3()), Vec3(0.1 * size * random.normal3()));
        ASSERT_GE(sum(pairs, off * found.X_WC), least * (1.0 - 1e-12));
      }
  }
}

TEST(RegisterProperty, ShiftingAndTurningTheSetsTurnsTheAnswer) {
  Stream random(4, "register");
  for (int i = 0; i < 300; ++i) {
    auto pairs = pairs_of(any_points(random, 6, Vec3(0.1, 0.1, 0.1)), any_pose(random));
    for (models::PointPair& p : pairs) p.device = p.device + Vec<'W'>(Vec3(0.001 * random.normal3()));
    const models::Registration before = models::register_points(pairs);
    const Pose<'W', 'W'> moved(any_rotation(random), random.normal3());
    for (models::PointPair& p : pairs) p.device = moved * p.device;
    const models::Registration after = models::register_points(pairs);
    const Pose<'W', 'C'> expected = moved * before.X_WC;
    ASSERT_LT((after.X_WC.p() - expected.p()).norm(), 1e-9);
    ASSERT_NEAR(after.rms, before.rms, 1e-12);
  }
}

// Fitzpatrick, West and Maurer 1998, IEEE Trans. Med. Imaging 17: with equal noise along all axes, the mean
// square error at a target is FLE^2 / N (1 + 1/3 sum over the set's axes of d^2 / f^2): d the target's, f the
// points' rms distance from that axis. And the mean square left over is (1 - 2/N) FLE^2.
TEST(RegisterProperty, ErrorsAtTargetsAsTheoryHasThem) {
  Stream random(5, "register");
  constexpr std::size_t kPairs = 8;
  constexpr double kNoise = 0.3e-3;  // m, along each axis
  // A cross of the axes: its middle and its axes are known.
  const Vec3 half(0.12, 0.06, 0.09);
  std::vector<Vec3> points;
  for (int sign : {-1, 1}) {
    for (Eigen::Index a = 0; a < 3; ++a) points.emplace_back(sign * half(a) * Vec3::Unit(a));
    points.emplace_back(Vec3::Zero());
  }
  const Vec3 along = half.cwiseAbs2() * 2.0 / kPairs;  // mean squares
  const Vec3 target(0.1, -0.15, 0.05);
  double theory = 0.0;
  for (Eigen::Index a = 0; a < 3; ++a)
    theory += (target.squaredNorm() - target(a) * target(a)) / (along.sum() - along(a)) / 3.0;
  const double fle = 3.0 * kNoise * kNoise;
  theory = fle / kPairs * (1.0 + theory);
  double there = 0.0, left = 0.0;
  constexpr int kRuns = 4000;
  for (int i = 0; i < kRuns; ++i) {
    const Pose<'W', 'C'> truth = any_pose(random);
    auto pairs = pairs_of(points, truth);
    for (models::PointPair& p : pairs) p.camera = p.camera + Vec<'C'>(Vec3(kNoise * random.normal3()));
    const models::Registration found = models::register_points(pairs);
    there += (found.X_WC * Point<'C'>(target) - truth * Point<'C'>(target)).e().squaredNorm() / kRuns;
    left += found.rms * found.rms / kRuns;
  }
  EXPECT_NEAR(there / theory, 1.0, 0.05);
  EXPECT_NEAR(left / (fle * (1.0 - 2.0 / kPairs)), 1.0, 0.05);
}

}  // namespace
}  // namespace enc
