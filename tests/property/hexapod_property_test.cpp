#include <random>

#include <gtest/gtest.h>

#include "core/machine/hexapod.h"

namespace enc {
namespace {

// Reachable poses, drawn over the catalogue's travels about the pivot and kept where the machine reaches.
struct RandomPose {
  const Hexapod& machine;
  std::mt19937_64 random;
  std::uniform_real_distribution<double> unit{-1.0, 1.0};
  Pose<'R', 'H'> draw() {
    for (;;) {
      const Quat q = Eigen::AngleAxisd(0.26 * unit(random), Vec3::UnitX()) *
                     Eigen::AngleAxisd(0.26 * unit(random), Vec3::UnitY()) *
                     Eigen::AngleAxisd(0.52 * unit(random), Vec3::UnitZ());
      const Vec3 pivot(0.080 * unit(random), 0.070 * unit(random), 0.180 + 0.026 * unit(random));
      const Pose<'R', 'H'> X_RH(q, Vec3(pivot + q * Vec3(0, 0, 0.160)));
      if (machine.limit(X_RH) == ReachLimit::none) return X_RH;
    }
  }
};

// Both quaternions of one rotation are the same pose.
double turn_between(const Pose<'R', 'H'>& a, const Pose<'R', 'H'>& b) {
  return 2.0 * (a.q().conjugate() * b.q()).vec().norm();
}

TEST(HexapodProperty, ForwardAfterInverseIsTheSamePose) {
  const Hexapod machine{HexapodGeometry{}};
  RandomPose poses{machine, std::mt19937_64(1)};
  double worst = 0.0, worst_turn = 0.0;
  int most_steps = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Pose<'R', 'H'> X_RH = poses.draw();
    const auto found = machine.forward(machine.inverse(X_RH), machine.zero());
    ASSERT_TRUE(found) << i;
    worst = std::max(worst, (found->X_RH.p() - X_RH.p()).norm());
    worst_turn = std::max(worst_turn, turn_between(found->X_RH, X_RH));
    most_steps = std::max(most_steps, found->steps);
  }
  EXPECT_LE(worst, 1e-9);
  EXPECT_LE(worst_turn, 1e-8);  // 1e-9 m at 0.1 m
  RecordProperty("most_newton_steps_from_zero", most_steps);
}

TEST(HexapodProperty, AtMostFourNewtonStepsFromATenthOfAMillimetre) {
  const Hexapod machine{HexapodGeometry{}};
  RandomPose poses{machine, std::mt19937_64(2)};
  int most = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Pose<'R', 'H'> X_RH = poses.draw();
    const Vec3 away =
        Vec3(poses.unit(poses.random), poses.unit(poses.random), poses.unit(poses.random)).normalized();
    const Pose<'R', 'H'> guess(X_RH.q(), Vec3(X_RH.p() + 1e-4 * away));
    const auto found = machine.forward(machine.inverse(X_RH), guess);
    ASSERT_TRUE(found) << i;
    most = std::max(most, found->steps);
  }
  EXPECT_LE(most, 4);
}

TEST(HexapodProperty, WorkspaceWithoutTurnsIs160By140By50) {
  // The extents of all places that are reached without turning the platform, on a grid of 1 mm (x, y) and 0.5
  // mm (z), each end then found to 1e-6 m.
  const Hexapod machine{HexapodGeometry{}};
  const auto ok = [&](const Vec3& p) {
    return machine.limit({Quat::Identity(), Vec3(machine.zero().p() + p)}) == ReachLimit::none;
  };
  Vec3 most = Vec3::Zero(), least = Vec3::Zero();
  const auto outward = [&](Vec3 p, int axis, double sign) {
    for (double step = 1e-3; step > 5e-7; step *= 0.5)
      while (ok(p + sign * step * Vec3::Unit(axis))) p(axis) += sign * step;
    return p(axis);
  };
  for (int ix = -90; ix <= 90; ++ix)
    for (int iy = -80; iy <= 80; ++iy)
      for (int iz = -60; iz <= 60; ++iz) {
        const Vec3 p(ix * 1e-3, iy * 1e-3, iz * 5e-4);
        if (!ok(p)) continue;
        for (int axis = 0; axis < 3; ++axis) {
          const double near = axis == 2 ? 1e-3 : 1.5e-3;
          if (p(axis) > most(axis) - near) most(axis) = std::max(most(axis), outward(p, axis, 1.0));
          if (p(axis) < least(axis) + near) least(axis) = std::min(least(axis), outward(p, axis, -1.0));
        }
      }
  const Vec3 extent = most - least;
  RecordProperty("x_um", static_cast<int>(extent.x() * 1e6));
  RecordProperty("y_um", static_cast<int>(extent.y() * 1e6));
  RecordProperty("z_um", static_cast<int>(extent.z() * 1e6));
  EXPECT_NEAR(extent.x() / 0.160, 1.0, 0.02) << extent.transpose();
  EXPECT_NEAR(extent.y() / 0.140, 1.0, 0.02) << extent.transpose();
  EXPECT_NEAR(extent.z() / 0.050, 1.0, 0.02) << extent.transpose();
  EXPECT_NEAR(extent.prod() / 1.12e-3, 1.0, 0.02)
      << extent.transpose();  // the paper's volume is that of the box
}

}  // namespace
}  // namespace enc
