// Frames, rotations, times and words. Chains of poses close, and chains that do not fit do not compile.
#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <string_view>
#include <utility>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/base/frames.h"
#include "core/base/latest.h"
#include "core/base/rotation.h"
#include "core/base/time.h"
#include "core/base/words.h"
#include "core/control/scene/scene.h"
#include "core/spec/rig_spec.h"
#include "models/schema/schema.h"

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

// A chain that fits and its type; chains that do not fit.
static_assert(std::same_as<decltype(Pose<'W', 'R'>{} * Pose<'R', 'H'>{}), Pose<'W', 'H'>>);
static_assert(std::same_as<decltype(Pose<'W', 'R'>{}.inverse()), Pose<'R', 'W'>>);
static_assert(!Multiplies<Pose<'W', 'R'>, Pose<'H', 'N'>>);
static_assert(!Multiplies<Pose<'W', 'R'>, Pose<'W', 'R'>>);
static_assert(!Multiplies<Pose<'W', 'R'>, Point<'W'>>);
static_assert(!Multiplies<Pose<'W', 'F'>, Vec<'N'>>);
static_assert(!std::convertible_to<Vec<'W'>, Vec<'F'>> &&
              !std::convertible_to<Pose<'W', 'R'>, Pose<'R', 'W'>>);
// A point is no vector: two points cannot be added, their difference is a vector, and turning a point is not
// moving it.
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

// Ground truth: every frame of [VHMR Fig 4] as a plain matrix. The edges of the graph are computed from
// these.
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
  // Difference between the end of a composed chain and its true pose.
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
    // The tool as located by the tracker, by headset and hand tracker, and by the machine.
    const auto X_WL = truth.edge<'W', 'S'>() * truth.edge<'S', 'G'>() * truth.edge<'G', 'L'>();
    const Pose<'F', 'T'> X_FT = truth.edge<'F', 'T'>();
    EXPECT_LT(truth.apart(X_WC * X_CT), 1e-9);
    EXPECT_LT(truth.apart(X_WL * X_LT), 1e-9);
    EXPECT_LT(truth.apart(X_WR * X_RH * X_HF * X_FT), 1e-9);
    // The tip as located by the tracker and by the object's surface, against the direction of half the edges.
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
  X.xyzw[3] = 1.0 + 2e-6;  // no longer a rotation
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

// The least rotation between two directions. Opposite directions always give the same axis: otherwise a
// record of a ceiling would not replay.

TEST(Rotation, BetweenTwoDirections) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  for (int i = 0; i < 10000; ++i) {
    const Vec3 from = any();
    const Vec3 to = i % 3 == 0 ? Vec3(-2.0 * from + (i % 2) * 0.05 * any()) : any();
    const Quat turn = rotation_between(from, to);
    const double cosine = std::clamp(from.normalized().dot(to.normalized()), -1.0, 1.0);
    // Nearly opposite: rounding of the cosine counts in full. From 1e-12 on, Eigen uses its SVD.
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

// Due times are multiples, never sums.

template <class A, class B>
concept SubtractsTime = requires(A a, B b) {
  a - b;
};
template <class C>
concept ClockWithNow = requires {
  C::now();
};
static_assert(!ClockWithNow<Epoch> && !SubtractsTime<Time, std::chrono::steady_clock::time_point> &&
              SubtractsTime<Time, Time>);

TEST(Every, DoesNotDriftAt120HzOverAnHour) {
  DueTimes every{120.0, 0, {}};
  std::int64_t due = 0;
  for (std::int64_t ms = 0; ms < 3'600'000; ++ms)
    while (every.due(Time(Duration(ms * 1'000'000)))) ++due;
  EXPECT_EQ(due, 120 * 3600);
  // Number 432,000 is due at 3600 s to the nanosecond; summing 8,333,333 ns would be 144 us early.
  EXPECT_EQ(every.next(), Time(Duration(3'600'000'000'000)));
  EXPECT_EQ((DueTimes{120.0, 1, {}}.next()), Time(Duration(8'333'333)));
  EXPECT_EQ((DueTimes{120.0, 2, {}}.next()), Time(Duration(16'666'667)));
}

TEST(Every, FirstIsDueAtItsPhase) {
  DueTimes now{60.0, 0, {}};
  EXPECT_TRUE(now.due(Time{}));
  EXPECT_FALSE(now.due(Time{}));
  DueTimes later{60.0, 0, Duration(5)};
  EXPECT_FALSE(later.due(Time(Duration(4))));
  EXPECT_TRUE(later.due(Time(Duration(5))));
}

TEST(Every, GivesEachMissedTimeOnce) {
  DueTimes every{1000.0, 0, {}};
  int due = 0;
  while (every.due(Time(Duration(5'500'000)))) ++due;
  EXPECT_EQ(due, 6);  // 0, 1, 2, 3, 4, 5 ms
}

TEST(Every, ARateOfZeroIsNeverDue) {
  DueTimes never;
  EXPECT_FALSE(never.due(Time(Duration(1'000'000'000))));
}

TEST(Seconds, AreTheNearestDoubleOfTheDecimal) {
  EXPECT_EQ(seconds(Duration(1'000'000'000)), 1.0);
  for (const auto& [ns, s] : {std::pair{45'000'000, 0.045},
                              {100'000'000, 0.1},
                              {5'000'000, 0.005},
                              {200'000'000, 0.2},
                              {50'000'000, 0.05}})
    EXPECT_EQ(seconds(Duration(ns)), s);  // so that an age of exactly a limit is not beyond it
  EXPECT_EQ(from_seconds(0.001), Duration(1'000'000));
  EXPECT_EQ(from_seconds(-0.0000000014), Duration(-1));
}

// The newest value of one thread for one reader thread. tests/threads tests the use from two threads.

TEST(Latest, NothingIsReadBeforeSomethingIsWritten) {
  LatestValue<int> latest;
  int value = 7;
  EXPECT_FALSE(latest.read(value));
  EXPECT_EQ(value, 7);
}

TEST(Latest, TheNewestIsReadOnceHoweverManyWereWritten) {
  LatestValue<int> latest;
  int value = 0, next = 1;
  for (int round = 0; round < 50; ++round) {
    for (int i = 0; i <= round % 5; ++i) latest.write(next++);
    ASSERT_TRUE(latest.read(value));
    EXPECT_EQ(value, next - 1);
    EXPECT_FALSE(latest.read(value));
    EXPECT_EQ(value, next - 1);
  }
}

// The words of the enums that a file can name are exactly the names of the values.

// The compiler's spelling: "plate" for PropKind::plate; "(enc::PropKind)3" has no name.
template <auto Value>
std::string_view spelled() {
  std::string_view text = __PRETTY_FUNCTION__;
  text = text.substr(text.find("Value = ") + 8);
  text = text.substr(0, text.find_first_of(";]"));
  if (text.front() == '(') return {};
  return text.substr(text.rfind(':') + 1);
}

template <class Enum>
class EnumWords : public ::testing::Test {};
using All = ::testing::Types<ShapeKind, TangentialMode, Reversal, TipShape, Interaction, PropKind, TremorForm,
                             UserKind, TravelWays, ManipulatorKind, Prediction, SegmentationMethod,
                             SquareReading, SeenTip, Damping, Tare, ArmKind, JointKind, GravityForm,
                             sim::HexapodForm, sim::TrackerClocks, sim::Packets, sim::ArmFriction,
                             sim::BallSet, sim::Scenery, sim::Tone, models::Confidence>;
TYPED_TEST_SUITE(EnumWords, All);

TYPED_TEST(EnumWords, AreTheNamesOfTheValues) {
  constexpr std::size_t kCount = kWords<TypeParam>.size();
  const auto one = [](std::string_view name, std::size_t i) {
    EXPECT_EQ(word_of(static_cast<TypeParam>(i)), name) << "value " << i;
  };
  [&]<std::size_t... I>(std::index_sequence<I...>) { (one(spelled<static_cast<TypeParam>(I)>(), I), ...); }
  (std::make_index_sequence<kCount>{});
  EXPECT_EQ(spelled<static_cast<TypeParam>(kCount)>(), "") << "a value without a word";
}

TEST(Counted, OneIsNotManyAndNoneIs) {
  EXPECT_EQ(counted(1, "contact"), "1 contact");
  EXPECT_EQ(counted(0, "contact"), "0 contacts");
  EXPECT_EQ(counted(std::size_t{2}, "contact"), "2 contacts");
  EXPECT_EQ(counted(std::int64_t{1}, "press"), "1 press");
  EXPECT_EQ(counted(std::int64_t{3}, "press"), "3 presses");
  EXPECT_EQ(counted(3, "touch"), "3 touches");
  EXPECT_EQ(counted(-2, "box"), "-2 boxes");
}

}  // namespace
}  // namespace enc
