// Fits: a response to a loop, a block to presses, a registration to points.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "models/identify/block_fit.h"
#include "models/identify/camera/register.h"
#include "models/identify/response/response_fit.h"
#include "sim/truth/random.h"
#include "tests/support/plant_loop.h"
#include "tests/support/refusal.h"

namespace enc::models {
namespace {

using testing::HasSubstr;

constexpr double kDeepest = 6e-3;  // m
constexpr int kReadings = 600;

using Curve = double (*)(double d_mm);  // N

std::vector<LoopPoint> loop_of(Curve press, Curve release) {
  std::vector<LoopPoint> loop;
  for (const bool pressing : {true, false})
    for (int i = 1; i <= kReadings; ++i) {
      const double d = kDeepest * i / kReadings;
      loop.push_back({d, (pressing ? press : release)(d * 1e3), pressing});
    }
  return loop;
}

// Root mean square of i / n, i = 1..n: sqrt((n + 1)(2 n + 1) / (6 n^2)).
double rms_of_ramp() { return std::sqrt((kReadings + 1.0) * (2.0 * kReadings + 1.0) / 6.0) / kReadings; }

double value(const std::array<double, 4>& a, double d) {
  return d * (a[0] + d * (a[1] + d * (a[2] + d * a[3])));
}
double slope(const std::array<double, 4>& a, double d) {
  return a[0] + d * (2 * a[1] + d * (3 * a[2] + d * 4 * a[3]));
}

double squares(const std::vector<LoopPoint>& loop, const ResponseSpec& spec) {
  double sum = 0.0;
  for (const LoopPoint& p : loop)
    sum += std::pow(value(p.pressing ? spec.press : spec.release, p.deflection) - p.force, 2);
  return sum;
}

// Least slope of both curves, and least gap, at 20,000 deflections between the fit's own.
struct LeastValues {
  double slope, gap;
};
LeastValues least(const ResponseSpec& spec) {
  LeastValues l{1e9, 1e9};
  for (int i = 0; i <= 20000; ++i) {
    const double d = spec.limit * i / 20000;
    l.slope = std::min({l.slope, slope(spec.press, d), slope(spec.release, d)});
    l.gap = std::min(l.gap, value(spec.press, d) - value(spec.release, d));
  }
  return l;
}

std::string refused_fit(const std::vector<LoopPoint>& loop, double limit = kDeepest, double floor = 100.0) {
  return test::refusal([&] { (void)fit_response(loop, limit, floor); });
}

TEST(ResponseFit, FindsCurvesThatNeedNoConstraint) {
  const auto press = [](double d) { return d * (1.0 + d * (0.2 + d * (-0.02 + d * 0.002))); };
  const auto release = [](double d) { return d * (0.5 + d * 0.1); };
  const ResponseFit fit = fit_response(loop_of(press, release), kDeepest, 119.0);
  EXPECT_NEAR(fit.spec.press[0], 1e3, 1e-6);
  EXPECT_NEAR(fit.spec.press[3], 0.002e12, 1e-3 * 0.002e12);
  EXPECT_NEAR(fit.spec.release[1], 0.1e6, 1e-6 * 0.1e6);
  EXPECT_LT(std::max({fit.rmse_press, fit.rmse_release, fit.rmse_press_free, fit.rmse_release_free}), 1e-9);
  EXPECT_EQ(fit.spec.limit, kDeepest);
}

// A release without force: no curve of slope >= s from zero lies below s d, so the best is s d itself; RMSE =
// s 6 mm rms(i / n).
TEST(ResponseFit, FloorAsByHand) {
  const auto loop = loop_of([](double d) { return 2.0 * d; }, [](double) { return 0.0; });
  const ResponseFit fit = fit_response(loop, kDeepest, 150.0);
  EXPECT_NEAR(fit.spec.release[0], 150.0, 0.05);
  EXPECT_NEAR(value(fit.spec.release, kDeepest), 0.9, 1e-3);
  EXPECT_NEAR(fit.rmse_release, 0.9 * rms_of_ramp(), 1e-3);
  EXPECT_NEAR(fit.rmse_release_free, 0.0, 1e-9);
  EXPECT_NEAR(fit.rmse_press, 0.0, 1e-9);
}

// Release measured above press, 2 and 1 N/mm: with p >= r the least (p - 1)^2 + (r - 2)^2 is p = r = 1.5
// N/mm; RMSE of each 0.5 N/mm 6 mm rms(i / n).
TEST(ResponseFit, OrderOfTheCurvesAsByHand) {
  const auto loop = loop_of([](double d) { return d; }, [](double d) { return 2.0 * d; });
  const ResponseFit fit = fit_response(loop, kDeepest, 119.0);
  EXPECT_NEAR(value(fit.spec.press, kDeepest), 9.0, 1e-3);
  EXPECT_NEAR(value(fit.spec.release, kDeepest), 9.0, 1e-3);
  EXPECT_NEAR(fit.rmse_press, 3.0 * rms_of_ramp(), 1e-3);
  EXPECT_NEAR(fit.rmse_release, 3.0 * rms_of_ramp(), 1e-3);
}

// The ball's loop and the cost of the constraints: the release curve cannot be flat below 0.5 mm, where the
// plant has lifted off.
TEST(ResponseFit, BallKeepsEveryConstraintAndSaysWhatItCosts) {
  const auto loop = test::plant_loop({}, 4e-3, kDeepest);
  for (const double floor : {0.0, 119.0, 124.95, 300.0}) {
    const ResponseFit fit = fit_response(loop, kDeepest, floor);
    const LeastValues l = least(fit.spec);
    EXPECT_GE(l.slope, floor) << floor;
    EXPECT_GE(l.gap, 0.0) << floor;
    EXPECT_EQ(Response(fit.spec, floor).limit(), kDeepest) << floor;
    EXPECT_NEAR(fit.rmse_press_free, 0.022, 0.001);
    EXPECT_NEAR(fit.rmse_release_free, 0.031, 0.001);
    EXPECT_GE(fit.rmse_release, fit.rmse_release_free);
    EXPECT_NEAR(std::sqrt(squares(loop, fit.spec) / static_cast<double>(loop.size())),
                std::sqrt(0.5 * (std::pow(fit.rmse_press, 2) + std::pow(fit.rmse_release, 2))), 1e-9);
  }
}

// The problem is convex: if no feasible neighbour is better, near or far, this is the minimum. Random
// neighbours are pulled towards a curve well inside the constraints until they are feasible.
TEST(ResponseFit, NoFeasibleNeighbourIsBetter) {
  constexpr double kLowest = 124.95;
  const auto loop = test::plant_loop({}, 4e-3, kDeepest);
  const ResponseFit fit = fit_response(loop, kDeepest, kLowest);
  const double best = squares(loop, fit.spec);
  std::mt19937_64 random(20);
  std::normal_distribution<double> normal;
  int better = 0, tried = 0;
  for (int n = 0; n < 2000; ++n) {
    ResponseSpec y = fit.spec;
    const double size = std::pow(10.0, -1.0 - 3.0 * n / 2000.0);  // N
    double power = 1.0;
    for (std::size_t k = 0; k < 4; ++k) {
      power *= kDeepest;
      const double inside_press = k == 0 ? 1500.0 : 0.0;  // N/m, straight lines
      const double inside_release = k == 0 ? 1000.0 : 0.0;
      y.press[k] += size * (normal(random) / power + 0.05 * (inside_press - y.press[k]));
      y.release[k] += size * (normal(random) / power + 0.05 * (inside_release - y.release[k]));
    }
    const LeastValues l = least(y);
    if (l.slope < kLowest || l.gap < 0.0) continue;
    ++tried;
    // The fit keeps 1.2e-4 N away from its constraints, which costs 6e-5 of the sum of squares.
    if (squares(loop, y) < best * (1.0 - 1e-4)) ++better;
  }
  EXPECT_GT(tried, 50);
  EXPECT_EQ(better, 0);
}

TEST(ResponseFit, RandomLoopsAreAlwaysRenderable) {
  std::mt19937_64 random(21);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 200; ++n) {
    std::vector<LoopPoint> loop;
    const std::array<double, 6> a{normal(random), normal(random), normal(random),
                                  normal(random), normal(random), normal(random)};
    for (const bool pressing : {true, false})
      for (int i = 0; i <= 60; ++i) {
        const double u = i / 60.0;
        const std::size_t at = pressing ? 0 : 3;
        const double force = 5.0 * (a[at] + u * (a[at + 1] + u * a[at + 2])) + 0.5 * normal(random);
        loop.push_back({u * kDeepest, force, pressing});
      }
    const ResponseFit fit = fit_response(loop, kDeepest, 119.0);  // throws if Response would refuse it
    const LeastValues l = least(fit.spec);
    ASSERT_GE(l.slope, 119.0) << "loop " << n;
    ASSERT_GE(l.gap, 0.0) << "loop " << n;
  }
}

TEST(ResponseFit, RefusesLoopsThatSayTooLittle) {
  auto loop = loop_of([](double d) { return 2.0 * d; }, [](double d) { return d; });
  EXPECT_EQ(refused_fit(loop), "");
  const std::vector<LoopPoint> press_only(loop.begin(), loop.begin() + kReadings);
  EXPECT_THAT(refused_fit(press_only), testing::HasSubstr("while releasing"));
  std::vector<LoopPoint> three;
  for (const bool pressing : {true, false})
    for (int i = 0; i < 30; ++i) three.push_back({2e-3 * (1 + i % 3), 1.0, pressing});
  EXPECT_THAT(refused_fit(three), testing::HasSubstr("four deflections"));
  EXPECT_THAT(refused_fit({}), testing::HasSubstr("four deflections"));
  loop[7].force = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refused_fit(loop), testing::HasSubstr("finite"));
  EXPECT_THAT(refused_fit(three, 0.0), testing::HasSubstr("limit"));
  EXPECT_THAT(refused_fit(three, kDeepest, -1.0), testing::HasSubstr("lowest slope"));
}

// Readings beyond the limit belong to another response and must change nothing.
TEST(ResponseFit, LeavesOutWhatLiesBeyondTheLimit) {
  auto loop = loop_of([](double d) { return 2.0 * d; }, [](double d) { return d; });
  const ResponseFit before = fit_response(loop, kDeepest, 119.0);
  loop.push_back({7e-3, 3.0, true});
  loop.push_back({-1e-3, 3.0, false});
  const ResponseFit after = fit_response(loop, kDeepest, 119.0);
  EXPECT_EQ(before.spec.press, after.spec.press);
  EXPECT_EQ(before.rmse_release, after.rmse_release);
}

TEST(BlockFit, FindsALineAndHowWellItIsKnown) {
  int held = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    sim::Stream noise(seed, "block fit");
    BlockFit fit(2, 0.25);
    for (int i = 0; i < 8000; ++i) {
      const double t = 1e-3 * i;
      fit.add(t, Eigen::Vector2d(1.0, std::sin(t)), 0.5 - 3.0 * std::sin(t) + 0.1 * noise.normal3().x());
    }
    const BlockFit::Result found = fit.solve();
    EXPECT_NEAR(found.values[0].value, 0.5, 0.01);
    EXPECT_NEAR(found.values[1].value, -3.0, 0.01);
    EXPECT_NEAR(found.rms, 0.1, 0.005);
    held += found.values[1].holds(-3.0) ? 1 : 0;
  }
  EXPECT_GE(held, 182);  // 95 % of 190, less three standard deviations of such a count
}

TEST(BlockFit, SaysNothingOfWhatItCannotTellApart) {
  BlockFit fit(4, 0.25);
  for (int i = 0; i < 1000; ++i) {
    const double x = std::cos(1e-2 * i);
    Eigen::VectorXd row(4);
    row << x, 2.0 * x, 0.0, 1.0;
    fit.add(1e-3 * i, row, 3.0 * x + 1.0);
  }
  const BlockFit::Result found = fit.solve();
  EXPECT_NEAR(found.values[0].value, 3.0, 1e-9);
  EXPECT_TRUE(std::isnan(found.values[1].value));  // equal to the first
  EXPECT_TRUE(std::isnan(found.values[2].value));  // not there
  EXPECT_NEAR(found.values[3].value, 1.0, 1e-9);
}

// Two blocks give no useful scatter: Student's t of one degree of freedom is 12.7.
TEST(BlockFit, OfTwoBlocksThereIsNoInterval) {
  for (const int blocks : {1, 2, 3, 4}) {
    sim::Stream noise(1, "block fit");
    BlockFit fit(1, 0.25);
    for (int i = 0; i < 250 * blocks; ++i)
      fit.add(1e-3 * i, Eigen::VectorXd::Ones(1), 2.0 + 0.1 * noise.normal3().x());
    const Interval mean = fit.solve().values[0];
    EXPECT_NEAR(mean.value, 2.0, 0.05);
    EXPECT_EQ(mean.known(), blocks > 2) << blocks;
  }
}

TEST(BlockFit, OfNothingKnowsNothing) {
  const BlockFit::Result found = BlockFit(1, 0.25).solve();
  EXPECT_TRUE(std::isnan(found.values[0].value));
  EXPECT_TRUE(std::isnan(found.rms));
}

// Absolute orientation by hand: four corners turned a quarter, refusals, and the angles of a file from a
// rotation.

constexpr double kQuarter = M_PI / 2;

// Points seen by a camera at `p` that is turned by `angles`.
std::vector<models::PointPair> pairs_of(const std::vector<Vec3>& camera, const Vec3& angles, const Vec3& p) {
  const Pose<'W', 'C'> X_WC(rotation_xyz(angles), p);
  std::vector<models::PointPair> pairs;
  for (const Vec3& c : camera) pairs.push_back({Point<'C'>(c), X_WC * Point<'C'>(c)});
  return pairs;
}
const std::vector<Vec3> kCorner{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}};

std::string refusal(const std::vector<models::PointPair>& pairs) {
  return test::refusal([&] { (void)models::register_points(pairs); });
}

TEST(Register, AQuarterTurnByHand) {
  // Quarter turn about z: x becomes y, y becomes -x.
  const std::vector<models::PointPair> pairs{{{0.1, 0, 0}, {1.0, 2.1, 3.0}},
                                             {{0, 0.1, 0}, {0.9, 2.0, 3.0}},
                                             {{0, 0, 0.1}, {1.0, 2.0, 3.1}},
                                             {{0, 0, 0}, {1.0, 2.0, 3.0}}};
  const models::Registration found = models::register_points(pairs);
  EXPECT_NEAR((found.X_WC.p() - Vec3(1, 2, 3)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((angles_xyz(found.X_WC.q()) - Vec3(0, 0, kQuarter)).norm(), 0.0, 1e-12);
  EXPECT_LT(found.rms, 1e-12);
  EXPECT_NEAR(found.scale, 1.0, 1e-12);
}

TEST(Register, TellsWhatIsLeftOverAlongEachAxis) {
  // An error of +-e along z at four corners of a square that neither a turn nor a shift can follow.
  constexpr double e = 0.001;
  std::vector<models::PointPair> pairs =
      pairs_of({{0.1, 0.1, 0}, {-0.1, 0.1, 0}, {-0.1, -0.1, 0}, {0.1, -0.1, 0}}, {0, 0, 0}, {0, 0, 0});
  for (std::size_t i = 0; i < 4; ++i) pairs[i].device.xyz[2] += i % 2 == 0 ? e : -e;
  const models::Registration found = models::register_points(pairs);
  EXPECT_NEAR(found.mean_error.z(), e, 1e-12);
  EXPECT_NEAR(found.rms_error.z(), e, 1e-12);
  EXPECT_NEAR(found.rms_error.head<2>().norm(), 0.0, 1e-12);
  EXPECT_NEAR(found.rms, e, 1e-12);
}

TEST(Register, ConditionOfAPlateAndOfARod) {
  // A square: its points hold half as much information about a turn around its longest axis (any in the
  // plane) as around the normal.
  const auto square =
      pairs_of({{0.1, 0.1, 0}, {-0.1, 0.1, 0}, {-0.1, -0.1, 0}, {0.1, -0.1, 0}}, {0.3, 0, 0}, {0, 0, 1});
  EXPECT_NEAR(models::register_points(square).condition, std::sqrt(2.0), 1e-9);
  // A rod of 100 mm either way, 10 mm wide either way: sqrt((100^2 + 10^2) / 10^2) = sqrt(101).
  const auto rod =
      pairs_of({{0.1, 0.01, 0}, {-0.1, 0.01, 0}, {-0.1, -0.01, 0}, {0.1, -0.01, 0}}, {0, 0, 0}, {0, 0, 0});
  EXPECT_NEAR(models::register_points(rod).condition, std::sqrt(101.0), 1e-6);
}

TEST(Register, PointsInAPlaneAreEnough) {
  const Vec3 angles(0.4, -1.1, 2.5);
  const auto pairs = pairs_of({{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0.1, 0.2, 0}}, angles, {0.3, 0, -1});
  const models::Registration found = models::register_points(pairs);
  EXPECT_NEAR(found.X_WC.q().angularDistance(rotation_xyz(angles)), 0.0, 1e-9);
  EXPECT_LT(found.rms, 1e-12);
}

TEST(Register, AMirrorImageStaysARotationAndIsTold) {
  std::vector<models::PointPair> pairs = pairs_of(kCorner, {0.1, 0.2, 0.3}, {0, 0, 0.5});
  for (models::PointPair& pair : pairs) pair.device.xyz[1] *= -1.0;
  const models::Registration found = models::register_points(pairs);
  EXPECT_NEAR(found.X_WC.q().toRotationMatrix().determinant(), 1.0, 1e-12);
  EXPECT_GT(found.rms, 0.01);
  EXPECT_LT(found.mirror_rms, 1e-7);
  // A wrong set gives an error.
  const models::Registration right = models::register_points(pairs_of(kCorner, {0.1, 0.2, 0.3}, {0, 0, 0.5}));
  EXPECT_GT(right.mirror_rms, 0.01);
}

TEST(Register, TellsThatOneSetIsLarger) {
  std::vector<models::PointPair> pairs = pairs_of(kCorner, {0, 0, 1}, {0, 0, 0});
  for (models::PointPair& pair : pairs)
    for (double& x : pair.camera.xyz) x *= 1.02;
  EXPECT_NEAR(models::register_points(pairs).scale, 1.02, 1e-12);
}

TEST(Register, RefusesWhatDoesNotFixAPose) {
  const Vec3 turn(0.1, 0.2, 0.3), p(0, 0, 0.6);
  EXPECT_THAT(refusal({}), HasSubstr("there are 0 pairs"));
  EXPECT_THAT(refusal(pairs_of({kCorner[0], kCorner[1], kCorner[2]}, turn, p)),
              HasSubstr("there are 3 pairs of points; expected at least 4"));
  const Vec3 along(0.03, -0.02, 0.05);
  EXPECT_THAT(refusal(pairs_of({0 * along, 1 * along, 2 * along, 5 * along}, turn, p)),
              HasSubstr("points lie on one line"));
  const Vec3 one(0.1, 0.2, 0.3);
  EXPECT_THAT(refusal(pairs_of({one, one, one, one}, turn, p)), HasSubstr("all in one place"));
  std::vector<models::PointPair> bad = pairs_of(kCorner, turn, p);
  bad[2].device.xyz[0] = kUnset;
  EXPECT_THAT(refusal(bad), HasSubstr("not a finite number"));
  bad[2].device.xyz[0] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal(bad), HasSubstr("not a finite number"));
  // The device's points are on a line, and the camera's are slightly off it by its noise: still a line.
  std::vector<models::PointPair> line = pairs_of({0 * along, 1 * along, 2 * along, 5 * along}, turn, p);
  line[1].camera.xyz[0] += 0.02;
  EXPECT_THAT(refusal(line), HasSubstr("the device's points lie on one line"));
  // Three points are enough if the caller asks for three.
  EXPECT_NO_THROW((void)models::register_points(pairs_of({kCorner[0], kCorner[1], kCorner[2]}, turn, p), 3));
}

TEST(Rotation, AnglesOfAFileThereAndBack) {
  for (const Vec3& angles : {Vec3(0, 0, 0), Vec3(0.5, -0.7, 2.9), Vec3(-2.18, 0, 0.52), Vec3(3.0, 1.5, -3.0)})
    EXPECT_NEAR((angles_xyz(rotation_xyz(angles)) - angles).norm(), 0.0, 1e-12);
  for (const double y : {kQuarter, -kQuarter}) {
    const Quat q = rotation_xyz({0.4, y, 0.3});
    EXPECT_NEAR(rotation_xyz(angles_xyz(q)).angularDistance(q), 0.0, 1e-7);
    EXPECT_EQ(angles_xyz(q).z(), 0.0);
  }
}

}  // namespace
}  // namespace enc::models
