// Chains of poses close, and chains that do not fit do not compile.
#include "core/base/frames.h"

#include <concepts>
#include <map>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/control/scene/scene.h"
#include "core/spec/rig_spec.h"

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

// Where every frame of [VHMR Fig 4] is, as plain matrices; the edges of the graph are read off them.
class Truth {
 public:
  explicit Truth(RandomPose& random) {
    for (const char frame : kFrames) {
      const auto X = random.pose<'W', 'O'>();
      if (frame != 'W') at_[frame] = (Eigen::Translation3d(X.p()) * X.q()).matrix();
    }
    at_['W'] = Eigen::Matrix4d::Identity();
  }
  [[nodiscard]] Eigen::Matrix4d matrix(char a, char b) const { return at_.at(a).inverse() * at_.at(b); }
  template <char A, char B>
  [[nodiscard]] Pose<A, B> edge() const {
    const Eigen::Matrix4d M = matrix(A, B);
    return {Quat(Mat3(M.topLeftCorner<3, 3>())), Vec3(M.topRightCorner<3, 1>())};
  }
  // Where a chain that somebody composed ends, against where it must.
  template <char A, char B>
  [[nodiscard]] double apart(const Pose<A, B>& X) const {
    const Eigen::Matrix4d said = (Eigen::Translation3d(X.p()) * X.q()).matrix();
    return (said - matrix(A, B)).norm();
  }

 private:
  std::map<char, Eigen::Matrix4d> at_;
};

TEST(Frames, ChainsCloseTo1e9) {
  RandomPose random;
  for (int i = 0; i < 10'000; ++i) {
    const Truth truth(random);
    const auto X_WR = truth.edge<'W', 'R'>();
    const auto X_RH = truth.edge<'R', 'H'>();
    const auto X_HF = truth.edge<'H', 'F'>();
    const auto X_WC = truth.edge<'W', 'C'>();
    const auto X_CT = truth.edge<'C', 'T'>();
    const auto X_WO = truth.edge<'W', 'O'>();
    const auto X_ON = truth.edge<'O', 'N'>();
    const auto X_LT = truth.edge<'L', 'T'>();
    // The tool by the tracker, by the headset and the hand tracker, and by what the machine would see of it.
    const auto X_WL = truth.edge<'W', 'S'>() * truth.edge<'S', 'G'>() * truth.edge<'G', 'L'>();
    const Pose<'F', 'T'> X_FT = truth.edge<'F', 'T'>();
    EXPECT_LT(truth.apart(X_WC * X_CT), 1e-9);
    EXPECT_LT(truth.apart(X_WL * X_LT), 1e-9);
    EXPECT_LT(truth.apart(X_WR * X_RH * X_HF * X_FT), 1e-9);
    // The tip as the tracker and as the object's surface would see it, against the flow of half the edges.
    EXPECT_LT(truth.apart(X_CT.inverse() * X_WC.inverse() * X_WR * X_RH), 1e-9);
    EXPECT_LT(truth.apart((X_WO * X_ON).inverse() * (X_WR * X_RH)), 1e-9);
    EXPECT_LT(truth.apart(X_HF.inverse() * X_RH.inverse() * X_WR.inverse() * X_WC), 1e-9);
    // A point and a vector of F, in C.
    const Point<'F'> p(0.3, -0.2, 0.1);
    const Vec<'F'> f(1, -2, 3);
    const Eigen::Matrix4d C_F = truth.matrix('C', 'F');
    const auto X_WF = X_WR * X_RH * X_HF;
    EXPECT_LT(((X_WC.inverse() * (X_WF * p)).e() - (C_F * p.e().homogeneous()).head<3>()).norm(), 1e-9);
    EXPECT_LT(((X_WC.inverse() * (X_WF * f)).e() - C_F.topLeftCorner<3, 3>() * f.e()).norm(), 1e-9);
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
