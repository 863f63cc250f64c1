// The least rotation between two directions, also where these are opposite and any axis at right angles would
// do: there it is always the same one, or a record of a ceiling would not replay.
#include "core/base/rotation.h"

#include <random>

#include <gtest/gtest.h>

namespace enc {
namespace {

TEST(Rotation, BetweenTwoDirections) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  for (int i = 0; i < 10000; ++i) {
    const Vec3 from = any();
    const Vec3 to = i % 3 == 0 ? Vec3(-2.0 * from + (i % 2) * 0.05 * any()) : any();
    const Quat turn = rotation_between(from, to);
    const double cosine = std::clamp(from.normalized().dot(to.normalized()), -1.0, 1.0);
    // Nearly opposite, rounding of the cosine counts in full; from 1e-12 on, Eigen takes its SVD.
    const double rounding = 1e-12 + (cosine > -1.0 + 1e-12 ? 1e-15 / (1.0 + cosine) : 0.0);
    ASSERT_NEAR(turn.norm(), 1.0, rounding) << i;
    ASSERT_LT(((turn * from).normalized() - to.normalized()).norm(), 1e-7) << i;
    const double angle = std::acos(cosine);
    ASSERT_NEAR(turn.angularDistance(Quat::Identity()), angle, 1e-6) << i;  // and no farther
  }
}

TEST(Rotation, OfACeilingIsAHalfTurnAboutX) {
  const Quat turn = rotation_z_to(-Vec3::UnitZ());
  EXPECT_EQ(turn.w(), 0.0);
  EXPECT_EQ(turn.x(), -1.0);
  EXPECT_EQ(turn.y(), 0.0);
  EXPECT_EQ(turn.z(), 0.0);
}

}  // namespace
}  // namespace enc
