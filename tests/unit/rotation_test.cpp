// The least rotation between two directions against Eigen's, which takes an SVD where they are opposite.
#include "core/rotation.h"

#include <random>

#include <gtest/gtest.h>

namespace enc {
namespace {

TEST(Rotation, BetweenTwoDirectionsIsEigensToTheBit) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  for (int i = 0; i < 10000; ++i) {
    const Vec3 from = any();
    const Vec3 to = i % 3 == 0 ? Vec3(-from + 1e-3 * any()) : any();  // every third nearly opposite
    const Quat ours = rotation_between(from, to);
    const Quat theirs = Quat::FromTwoVectors(from, to);
    ASSERT_EQ(ours.coeffs(), theirs.coeffs()) << i;
  }
}

TEST(Rotation, OfOppositeDirectionsIsAHalfTurnAboutAnAxisAtRightAngles) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    Vec3 from(normal(random), normal(random), normal(random));
    if (i < 6) from = (i % 2 == 0 ? 1.0 : -1.0) * Vec3::Unit(i / 2);
    const Quat turn = rotation_between(from, -2.0 * from);
    ASSERT_NEAR(turn.norm(), 1.0, 1e-12) << i;
    ASSERT_NEAR(turn.w(), 0.0, 1e-6) << i;
    ASSERT_LT((turn * from + from).norm(), 1e-7 * from.norm()) << i;
    const Vec3 to = -from + 1e-7 * from.norm() * Vec3(normal(random), normal(random), normal(random));
    ASSERT_LT(((rotation_between(from, to) * from).normalized() - to.normalized()).norm(), 3e-8) << i;
  }
}

}  // namespace
}  // namespace enc
