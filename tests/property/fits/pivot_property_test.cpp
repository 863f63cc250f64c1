// Pivot calibration of drawn poses: the tip is as near as it is told, and inside of its intervals as often as
// these say.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "models/identify/tip/pivot_fit.h"
#include "sim/truth/random.h"

namespace enc {
namespace {

using models::PivotFit;
using models::PivotPose;
using sim::Stream;

constexpr double kSide = 30.0 * M_PI / 180.0;                     // of the swing, to either side
const Vec3 kTip(0.001, -0.002, -0.120), kDimple(0.1, -0.9, 0.6);  // in T and in C, m
const std::vector<Vec3> kMarkers{{0, 0, 0}, {0.052, 0, 0}, {0, 0.041, 0}, {-0.017, -0.030, 0.012}};

using Tracker = std::function<Pose<'C', 'T'>(const Pose<'C', 'T'>&)>;

// How a person swings the tool, s. At rest it stands as it does when it begins to turn.
struct Swing {
  bool one_after_the_other = false;  // about x and then about y, or both at once
  double lasts = 20.0;
  double rests = 0.0;  // before it, with a tracker of its own
};

// At 100 Hz.
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

// Noise of four markers, m, to which the pose is fitted.
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

// Errors that last for some 0.1 s, as those of a tracker that filters, or for longer.
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
  std::array<int, 3> held{0, 0, 0};  // by the intervals
  int near = 0;                      // within 0.1 mm
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

// 0.3 mm of each marker: 0.15 mm of their middle, 0.3 deg of the pose.
TEST(PivotProperty, RoughMarkersTellTheTipToATenthOfAMillimetre) {
  for (const bool one_after_the_other : {false, true}) {
    const Tally all = tally(
        "markers", {one_after_the_other}, [](Stream& r) { return of_markers(r, 0.3e-3); }, 100);
    EXPECT_GE(all.near, 95 * all.draws / 100);
    expect_held(all);
  }
}

// Plain least squares put it 0.02 mm too near to the markers, and the intervals beside it.
TEST(PivotProperty, NoiseOfTheRotationDrawsNoTipToTheMarkers) {
  const Tally all =
      tally("rough", {true}, [](Stream& r) { return noisy(r, Vec3::Constant(0.15e-3), 0.2 * M_PI / 180.0); });
  EXPECT_LE(std::abs(all.mean.z()), 0.01e-3);  // of a mean that scatters by 0.0015 mm
  expect_held(all);
}

TEST(PivotProperty, NeighbouringErrorsThatAreAlikeMakeTheIntervalsWider) {
  for (const bool one_after_the_other : {false, true})
    expect_held(
        tally("slow", {one_after_the_other}, [](Stream& r) { return slow(r, 0.15e-3, 0.2 * M_PI / 180.0); }));
}

// Few blocks tell little of how unlike they are.
TEST(PivotProperty, ShortLogsHaveWiderIntervals) {
  for (const double lasts : {4.0, 5.0, 6.0, 8.0})
    for (const bool one_after_the_other : {false, true}) {
      SCOPED_TRACE(lasts);
      expect_held(tally("short", {one_after_the_other, lasts},
                        [](Stream& r) { return slow(r, 0.15e-3, 0.2 * M_PI / 180.0); }));
    }
}

// What `intervals` of `encounter calibrate tip` promises.
TEST(PivotProperty, ErrorsMayLastForAThirdOfASecond) {
  for (const double lasts : {8.0, 20.0})
    for (const bool one_after_the_other : {false, true}) {
      SCOPED_TRACE(lasts);
      expect_held(tally("long", {one_after_the_other, lasts},
                        [](Stream& r) { return slow(r, 0.15e-3, 0.2 * M_PI / 180.0, 0.3); }));
    }
}

// A tracker is quieter while the tool rests, which is no reason to leave its swing out.
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

}  // namespace
}  // namespace enc
