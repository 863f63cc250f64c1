// Chains of poses close, and chains that do not fit do not compile.
#include "core/frames.h"

#include <concepts>
#include <random>

#include <gtest/gtest.h>

#include "core/rig_spec.h"
#include "core/scene.h"

namespace enc {
namespace {

template <class A, class B>
concept Multiplies = requires(A a, B b) {
  a* b;
};
template <class A, class B>
concept Subtracts = requires(A a, B b) {
  a - b;
};
template <class A, class B>
concept Adds = requires(A a, B b) {
  a + b;
};
template <char A>
concept IsFrame = requires {
  typename Point<A>;
};

// A chain that fits, and what it is; chains that do not.
static_assert(std::same_as<decltype(Pose<'W', 'R'>{} * Pose<'R', 'H'>{}), Pose<'W', 'H'>>);
static_assert(std::same_as<decltype(Pose<'W', 'R'>{}.inverse()), Pose<'R', 'W'>>);
static_assert(!Multiplies<Pose<'W', 'R'>, Pose<'H', 'N'>>);
static_assert(!Multiplies<Pose<'W', 'R'>, Pose<'W', 'R'>>);
static_assert(!Multiplies<Pose<'W', 'R'>, Point<'W'>>);
static_assert(!Multiplies<Pose<'W', 'F'>, Vec<'N'>>);
static_assert(!std::convertible_to<Vec<'W'>, Vec<'F'>> &&
              !std::convertible_to<Pose<'W', 'R'>, Pose<'R', 'W'>>);
// A point is no vector: two places do not add, their difference is a vector, and turning is not moving.
static_assert(!std::convertible_to<Point<'W'>, Vec<'W'>> && !std::convertible_to<Vec<'W'>, Point<'W'>>);
static_assert(!Adds<Point<'W'>, Point<'W'>> && Adds<Point<'W'>, Vec<'W'>> && !Adds<Point<'W'>, Vec<'R'>>);
static_assert(std::same_as<decltype(Point<'W'>{} - Point<'W'>{}), Vec<'W'>> &&
              !Subtracts<Point<'W'>, Point<'R'>>);
static_assert(!IsFrame<'X'> && IsFrame<'W'>);  // no such letter

struct RandomPose {
  std::mt19937_64 random{11};
  std::normal_distribution<double> normal;
  template <char A, char B>
  Pose<A, B> pose() {
    const Quat q = Quat(normal(random), normal(random), normal(random), normal(random)).normalized();
    return {q, Vec3(normal(random), normal(random), normal(random))};
  }
};

TEST(Frames, ChainsCloseTo1e9) {
  RandomPose random;
  for (int i = 0; i < 10'000; ++i) {
    const auto X_WR = random.pose<'W', 'R'>();
    const auto X_RH = random.pose<'R', 'H'>();
    const auto X_HF = random.pose<'H', 'F'>();
    const auto X_WC = random.pose<'W', 'C'>();
    const Pose<'W', 'F'> X_WF = X_WR * X_RH * X_HF;
    // Round the loop and back: W F H R W.
    const Pose<'W', 'W'> round = X_WF * X_HF.inverse() * X_RH.inverse() * X_WR.inverse();
    EXPECT_LT(round.p().norm(), 1e-9);
    EXPECT_LT(round.q().angularDistance(Quat::Identity()), 1e-7);  // acos near 1 resolves no more
    EXPECT_LT(round.q().coeffs().head<3>().norm(), 1e-9);
    // The same point by two ways, and through matrices.
    const Point<'F'> p_F(0.3, -0.2, 0.1);
    const Point<'C'> one = X_WC.inverse() * (X_WF * p_F);
    const Point<'C'> other = (X_WC.inverse() * X_WR) * (X_RH * (X_HF * p_F));
    EXPECT_LT((one - other).norm(), 1e-9);
    const Eigen::Vector4d by_matrix = (Eigen::Translation3d(X_WR.p()) * X_WR.q()).matrix() *
                                      (Eigen::Translation3d(X_RH.p()) * X_RH.q()).matrix() *
                                      Eigen::Vector4d(1, 2, 3, 1);
    EXPECT_LT((by_matrix.head<3>() - (X_WR * X_RH * Point<'H'>(1, 2, 3)).e()).norm(), 1e-9);
    EXPECT_TRUE(X_WF.valid());
  }
}

TEST(Frames, APoseMovesPointsAndOnlyTurnsVectors) {
  // A quarter turn about z and 1 m along x: the point (1, 0, 0) goes to (1, 1, 0), the vector to (0, 1, 0).
  const Pose<'W', 'R'> X_WR(Quat(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ())), Vec3(1, 0, 0));
  EXPECT_LT((X_WR * Point<'R'>(1, 0, 0) - Point<'W'>(1, 1, 0)).norm(), 1e-15);
  EXPECT_LT((X_WR * Vec<'R'>(1, 0, 0) - Vec<'W'>(0, 1, 0)).norm(), 1e-15);
  EXPECT_LT((X_WR.inverse() * Point<'W'>(1, 1, 0) - Point<'R'>(1, 0, 0)).norm(), 1e-15);
}

TEST(Frames, WhatIsNotSetIsNaNAndNotValid) {
  EXPECT_FALSE((Pose<'W', 'R'>{}.valid()));
  EXPECT_TRUE(std::isnan(Point<'W'>{}.xyz[1]) && std::isnan(Vec<'W'>{}.xyz[2]));
  EXPECT_TRUE((Pose<'W', 'R'>::identity().valid()));
  Pose<'W', 'R'> X = Pose<'W', 'R'>::identity();
  X.xyzw[3] = 1.0 + 2e-6;  // no rotation any more
  EXPECT_FALSE(X.valid());
}

TEST(Frames, RotationToTurnsZOntoTheNormal) {
  RandomPose random;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 n = random.pose<'W', 'R'>().p().normalized();
    EXPECT_LT((rotation_z_to(n) * Vec3::UnitZ() - n).norm(), 1e-12);
  }
  EXPECT_LT((rotation_z_to(-Vec3::UnitZ()) * Vec3::UnitZ() + Vec3::UnitZ()).norm(), 1e-12);
}

TEST(Frames, PoseOfTurnsAboutFixedXThenYThenZ) {
  // x: (0,1,0) -> (0,0,1); then z keeps it.  y is 0.
  const auto X = pose_of<'W', 'C'>({{1, 2, 3}, {M_PI / 2, 0, M_PI / 2}});
  EXPECT_LT((X * Point<'C'>(0, 1, 0) - Point<'W'>(1, 2, 4)).norm(), 1e-12);
  // x: (0,0,1) -> (0,-1,0); then z: -> (1,0,0).
  EXPECT_LT((X * Point<'C'>(0, 0, 1) - Point<'W'>(2, 2, 3)).norm(), 1e-12);
}

}  // namespace
}  // namespace enc
