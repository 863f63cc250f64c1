// Fits on drawn data: loops of one law, pivot calibration, and registration of point sets return results with
// errors inside their intervals.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/base/rotation.h"
#include "models/identify/camera/register.h"
#include "models/identify/response/loop_fit.h"
#include "models/identify/tip/pivot_fit.h"
#include "sim/truth/random.h"
#include "tests/support/built.h"
#include "tests/support/plant_loop.h"

namespace enc {
namespace {

using models::LoopData;
using models::LoopFit;
using models::PivotFit;
using models::PivotPose;
using sim::Stream;
using test::LawLoop;

// ---- `fit` on loops of one law, as rigs record them. At any speeds, holds, rates and zeros the curves are
// those of the law. They lie inside their intervals as often as these state.

constexpr double kLimit = 6e-3, kFloor = 124.95;  // m, N/m
constexpr double kNear = 0.02;                    // N

struct LoopFitCase {
  LoopData loop;
  LoopFit fit;
};
LoopFitCase fitted(const LawLoop& made, std::uint64_t seed) {
  LoopFitCase all;
  all.loop = models::parse_loop(test::law_loop_csv(made, seed), "law.csv", kLimit);
  all.fit = models::fit_loop(all.loop, {kLimit, kFloor, kUnset});
  return all;
}

void expect_law(const LoopFit& fit, double near = kNear) {
  EXPECT_NEAR(fit.press.curve.back().value, test::law_force(6.0, true), near);
  EXPECT_NEAR(fit.release.curve.back().value, test::law_force(6.0, false), near);
  EXPECT_NEAR(fit.press.curve.front().value, test::law_force(1.0, true), near);
  EXPECT_NEAR(fit.release.curve.front().value, test::law_force(1.0, false), near);
  for (const models::BranchEstimate* branch : {&fit.press, &fit.release})
    for (const models::LoopEstimate& k : branch->curve) {
      EXPECT_GT(k.half, 0.0);
      EXPECT_LT(k.half, 0.1);
    }
}

TEST(LoopProperty, NeitherSpeedsNorHoldsMoveTheCurves) {
  for (const double ratio : {0.1, 0.5, 1.0, 3.0, 10.0, 20.0})
    for (const double hold : {0.0, 0.05, 1.0, 30.0}) {
      if (hold == 30.0 && ratio != 1.0 && tests::thorough(0, 1) == 0) continue;
      LawLoop made;
      made.out_mm_s = ratio * made.in_mm_s;
      made.hold_s = hold;
      made.relaxes = 0.1;
      made.repeats = ratio < 1.0 ? 2 : 5;
      for (int seed = 1; seed <= tests::thorough(1, 5); ++seed) {
        SCOPED_TRACE(testing::Message() << ratio << " times as fast out, " << hold << " s, seed " << seed);
        const LoopFitCase all = fitted(made, static_cast<std::uint64_t>(seed));
        expect_law(all.fit);
        EXPECT_TRUE(all.loop.notes.empty()) << all.loop.notes.front();
      }
    }
}

// Counts how often the law lies inside the interval, at 1 to 6 mm of either branch.
struct Inside {
  int draws = 0;
  std::array<std::array<int, 6>, 2> held{};
};
Inside count(const LawLoop& made, int draws) {
  Inside inside;
  for (; inside.draws < draws; ++inside.draws) {
    const LoopFit fit = fitted(made, static_cast<std::uint64_t>(inside.draws) + 1).fit;
    for (const bool pressing : {true, false}) {
      const auto& curve = (pressing ? fit.press : fit.release).curve;
      for (std::size_t i = 0; i < curve.size(); ++i)
        inside.held[pressing ? 0 : 1][i] +=
            std::abs(curve[i].value - test::law_force(static_cast<double>(i + 1), pressing)) <= curve[i].half;
    }
  }
  return inside;
}
void expect_inside(const LawLoop& made, const char* what) {
  SCOPED_TRACE(what);
  const Inside inside = count(made, tests::thorough(10, 100));
  for (const auto& branch : inside.held)
    for (std::size_t i = 0; i < branch.size(); ++i)
      EXPECT_GE(branch[i], 9 * inside.draws / 10)
          << (&branch == inside.held.data() ? "pressing " : "releasing ") << i + 1 << " mm";
}

TEST(LoopProperty, IntervalsHoldTheLaw) {
  expect_inside({}, "at 4 mm/s");
  expect_inside({.out_mm_s = 40.0}, "out at 40 mm/s");
  expect_inside({.hold_s = 1.0, .relaxes = 0.1, .rate_Hz = 200.0}, "at 200 Hz, with a hold");
  expect_inside({.repeats = 1}, "one press");
  expect_inside({.zero_N = 0.6, .zero_drift_N = 0.05, .marks_all = true}, "with a zero that drifts");
  expect_inside({.begin_mm = 2.0, .marks_all = true}, "with contact that begins at 2 mm");
}

// The force before contact is not 0, contact does not begin at 0, or both.
TEST(LoopProperty, ZeroAndBeginArePutRight) {
  for (const double zero : {-0.3, 0.0, 0.6})
    for (const double begin : {-0.5, 0.0, 0.1, 2.0})
      for (const double drift : {0.0, 0.1})
        for (const bool marks_all : {true, false}) {
          if (marks_all == (drift != 0.0) && tests::thorough(0, 1) == 0) continue;
          SCOPED_TRACE(testing::Message() << zero << " N, " << drift << " N more each time, " << begin
                                          << " mm, " << (marks_all ? "all rows marked" : "contact marked"));
          LawLoop made;
          made.zero_N = zero;
          made.zero_drift_N = drift;
          made.begin_mm = begin;
          made.marks_all = marks_all;
          const LoopFitCase all = fitted(made, 1);
          expect_law(all.fit);
          EXPECT_EQ(all.loop.notes.size(),
                    (zero != 0.0 || drift != 0.0 ? 1U : 0U) + (begin != 0.0 ? 1U : 0U));
        }
}

// Coarse rates, noisy positions, an overshoot before the hold, a rest near contact.
TEST(LoopProperty, RatesAndNoiseOnlyWidenTheIntervals) {
  const std::vector<LawLoop> all{{.rate_Hz = 100.0},
                                 {.hold_s = 5.0, .rate_Hz = 60.0},
                                 {.hold_s = 5.0, .deflection_noise_mm = 0.0, .force_noise_N = 0.0},
                                 {.hold_s = 3.0, .deflection_noise_mm = 0.02},
                                 {.hold_s = 10.0, .relaxes = 0.2, .overshoot_mm = 0.05},
                                 {.force_noise_N = 0.1},
                                 {.clear_mm = 0.5, .repeats = 3},
                                 {.clear_mm = 10.0}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    SCOPED_TRACE(i);
    const LoopFit fit = fitted(all[i], 1).fit;
    EXPECT_NEAR(fit.press.curve.back().value, test::law_force(6.0, true),
                kNear + fit.press.curve.back().half);
    EXPECT_NEAR(fit.release.curve.back().value, test::law_force(6.0, false),
                kNear + fit.release.curve.back().half);
    EXPECT_LT(fit.press.curve.back().half, 0.15);
    EXPECT_LT(fit.release.curve.back().half, 0.15);
  }
}

// ---- Pivot calibration of drawn poses: the tip is within its stated accuracy, and inside its intervals as
// often as these state.

constexpr double kSide = 30.0 * M_PI / 180.0;                     // swing to either side
const Vec3 kTip(0.001, -0.002, -0.120), kDimple(0.1, -0.9, 0.6);  // in T and in C, m
const std::vector<Vec3> kMarkers{{0, 0, 0}, {0.052, 0, 0}, {0, 0.041, 0}, {-0.017, -0.030, 0.012}};

using Tracker = std::function<Pose<'C', 'T'>(const Pose<'C', 'T'>&)>;

// Durations of a person's swing of the tool, s. During the rest the tool stands as at the beginning of its
// turn.
struct Swing {
  bool one_after_the_other = false;  // about x and then about y, or both at once
  double lasts = 20.0;
  double rests = 0.0;  // s of rest before the swing, with a tracker of its own
};

// Poses of the swing at 100 Hz.
std::vector<PivotPose> swung(const Swing& swing, const Tracker& tracker, const Tracker& at_rest = {}) {
  std::vector<PivotPose> poses;
  const int rest = static_cast<int>(std::lround(100.0 * swing.rests));
  for (int i = -rest; i <= static_cast<int>(std::lround(100.0 * swing.lasts)); ++i) {
    const double t = std::max(0.0, 0.01 * i);
    const double x = kSide * std::sin(M_PI * t), y = kSide * std::sin(0.74 * M_PI * t + 1.0);
    const bool first = t < 0.5 * swing.lasts || !swing.one_after_the_other;
    const bool second = t >= 0.5 * swing.lasts || !swing.one_after_the_other;
    const Quat q(Eigen::AngleAxisd(first ? x : 0.0, Vec3::UnitX()) *
                 Eigen::AngleAxisd(second ? y : 0.0, Vec3::UnitY()));
    poses.push_back({0.01 * (i + rest), (i < 0 ? at_rest : tracker)({q, Vec3(kDimple - q * kTip)})});
  }
  return poses;
}

Quat turned(const Vec3& by) {
  const double angle = by.norm();
  return angle > 0.0 ? Quat(Eigen::AngleAxisd(angle, by / angle)) : Quat::Identity();
}

// Noise of the pose itself, m (along x, y, z of C) and rad, beside a constant bias.
Tracker noisy(Stream& random, const Vec3& place, double turn, const Vec3& bias = Vec3::Zero()) {
  return [&random, place, turn, bias ](const Pose<'C', 'T'>& X) -> Pose<'C', 'T'> {
    const Quat q = X.q() * turned(turn * random.normal3());
    return {q.normalized(), Vec3(X.p() + bias + place.cwiseProduct(random.normal3()))};
  };
}

// Noise of the four markers, m, from which the pose is fitted.
Tracker of_markers(Stream& random, double noise) {
  return [&random, noise ](const Pose<'C', 'T'>& X) -> Pose<'C', 'T'> {
    Eigen::Matrix<double, 3, 4> there, seen;
    for (Eigen::Index m = 0; m < 4; ++m) {
      there.col(m) = kMarkers[static_cast<std::size_t>(m)];
      seen.col(m) = (X * Point<'T'>(Vec3(there.col(m)))).e() + noise * random.normal3();
    }
    const Eigen::Matrix4d found = Eigen::umeyama(there, seen, false);
    return {Quat(Mat3(found.topLeftCorner<3, 3>())).normalized(), Vec3(found.topRightCorner<3, 1>())};
  };
}

// Errors that last for some 0.1 s, as from a tracker that filters, or longer.
Tracker slow(Stream& random, double place, double turn, double lasts = 0.1) {
  std::array<Vec3, 2> off{random.normal3(), random.normal3()};
  return [&random, place, turn, lasts, off ](const Pose<'C', 'T'>& X) mutable -> Pose<'C', 'T'> {
    const double stays = std::exp(-0.01 / lasts);
    for (Vec3& x : off) x = stays * x + std::sqrt(1.0 - stays * stays) * random.normal3();
    return {(X.q() * turned(turn * off[1])).normalized(), Vec3(X.p() + place * off[0])};
  };
}

struct Tally {
  int draws = 0;
  std::array<int, 3> held{0, 0, 0};  // counts of intervals that hold, per axis
  int near = 0;                      // count within 0.1 mm
  Vec3 mean = Vec3::Zero();          // error, m
};
using Trackers = std::function<Tracker(Stream&)>;
Tally tally(const std::string& name, const Swing& swing, const Trackers& tracker, int draws = 300,
            const Trackers& at_rest = {}) {
  Tally all;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(draws); ++seed) {
    Stream random(seed, name);
    const PivotFit fit =
        models::fit_pivot(swung(swing, tracker(random), at_rest ? at_rest(random) : Tracker{}));
    const Vec3 error = fit.point().e() - kTip;
    for (std::size_t a = 0; a < 3; ++a)
      all.held[a] += fit.tip[a].holds(kTip(static_cast<Eigen::Index>(a))) ? 1 : 0;
    all.near += error.norm() <= 0.1e-3 ? 1 : 0;
    all.mean += error / draws;
    ++all.draws;
  }
  return all;
}

void expect_held(const Tally& all) {
  for (const int held : all.held) EXPECT_GE(held, 95 * all.draws / 100);
}

// [truth.tracker] of models/rigs/sim.toml: its noise, and its bias, which is constant.
TEST(PivotProperty, TheShippedTrackerTellsTheTip) {
  const Vec3 noise = 1e-3 * Vec3(0.0191, 0.0115, 0.0109), bias = 1e-3 * Vec3(0.0779, 0.0659, 0.1192);
  const Tally all = tally("shipped", {}, [&](Stream& r) { return noisy(r, noise, 0.0, bias); });
  EXPECT_EQ(all.near, all.draws);
  expect_held(all);
}

TEST(PivotProperty, ATrackerThatTurnsALittleTellsTheTip) {
  const Tally all =
      tally("fine", {}, [](Stream& r) { return noisy(r, Vec3::Constant(0.015e-3), 0.02 * M_PI / 180.0); });
  EXPECT_EQ(all.near, all.draws);
  expect_held(all);
}

// 0.3 mm for each marker: 0.15 mm for their middle, 0.3 deg for the pose.
TEST(PivotProperty, RoughMarkersTellTheTipToATenthOfAMillimetre) {
  for (const bool one_after_the_other : {false, true}) {
    const Tally all = tally(
        "markers", {one_after_the_other}, [](Stream& r) { return of_markers(r, 0.3e-3); }, 100);
    EXPECT_GE(all.near, 95 * all.draws / 100);
    expect_held(all);
  }
}

// Plain least squares place the tip 0.02 mm too near to the markers, outside their intervals.
TEST(PivotProperty, NoiseOfTheRotationDrawsNoTipToTheMarkers) {
  const Tally all =
      tally("rough", {true}, [](Stream& r) { return noisy(r, Vec3::Constant(0.15e-3), 0.2 * M_PI / 180.0); });
  EXPECT_LE(std::abs(all.mean.z()), 0.01e-3);  // for a mean that scatters by 0.0015 mm
  expect_held(all);
}

TEST(PivotProperty, NeighbouringErrorsThatAreAlikeMakeTheIntervalsWider) {
  for (const bool one_after_the_other : {false, true})
    expect_held(
        tally("slow", {one_after_the_other}, [](Stream& r) { return slow(r, 0.15e-3, 0.2 * M_PI / 180.0); }));
}

// A few blocks carry little information about their scatter.
TEST(PivotProperty, ShortLogsHaveWiderIntervals) {
  for (const double lasts : {4.0, 5.0, 6.0, 8.0})
    for (const bool one_after_the_other : {false, true}) {
      SCOPED_TRACE(lasts);
      expect_held(tally("short", {one_after_the_other, lasts},
                        [](Stream& r) { return slow(r, 0.15e-3, 0.2 * M_PI / 180.0); }));
    }
}

// The promise of `intervals` of `encounter calibrate tip`.
TEST(PivotProperty, ErrorsMayLastForAThirdOfASecond) {
  for (const double lasts : {8.0, 20.0})
    for (const bool one_after_the_other : {false, true}) {
      SCOPED_TRACE(lasts);
      expect_held(tally("long", {one_after_the_other, lasts},
                        [](Stream& r) { return slow(r, 0.15e-3, 0.2 * M_PI / 180.0, 0.3); }));
    }
}

// A tracker is quieter while the tool rests; the fit must still use the swing.
TEST(PivotProperty, ARestBeforeTheSwingDoesNoHarm) {
  for (const double rests : {15.0, 12.0})
    for (const bool one_after_the_other : {false, true}) {
      SCOPED_TRACE(rests);
      expect_held(tally(
          "rest", {one_after_the_other, 20.0 - rests, rests},
          [](Stream& r) { return noisy(r, Vec3::Constant(0.1e-3), 0.05 * M_PI / 180.0); }, 200,
          [](Stream& r) { return noisy(r, Vec3::Constant(0.015e-3), 0.01 * M_PI / 180.0); }));
    }
}

// ---- Registration on seeded random sets: the fit recovers known transforms and finds the least error. Noise
// moves other points as theory predicts.

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
    // The sets are round, flat (a plane) or long, up to a length of 50 times their width.
    const double flat = i % 4 == 0 ? 0.0 : std::exp(-3.9 * random.uniform());
    const double narrow = std::exp(-3.9 * random.uniform());
    const Vec3 size = 0.1 * Vec3(1.0, narrow, flat);
    const auto points = any_points(random, 4 + static_cast<std::size_t>(random.bits() % 17), size);
    models::Registration found;
    try {
      found = models::register_points(pairs_of(points, truth));
    } catch (const std::exception&) {
      continue;  // four random points may lie on a line; counted below
    }
    ASSERT_LT((found.X_WC.p() - truth.p()).norm(), 1e-9) << i;
    ASSERT_LT(found.X_WC.q().angularDistance(truth.q()), 1e-7) << i;  // acos is imprecise near 1
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
// square error at a target is FLE^2 / N (1 + 1/3 sum over the set's axes of d^2 / f^2). d is the target's
// distance from that axis, f the points' rms distance. The mean square residual is (1 - 2/N) FLE^2.
TEST(RegisterProperty, ErrorsAtTargetsAsTheoryHasThem) {
  Stream random(5, "register");
  constexpr std::size_t kPairs = 8;
  constexpr double kNoise = 0.3e-3;  // m, along each axis
  // A cross of the axes has a known middle and known axes.
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
