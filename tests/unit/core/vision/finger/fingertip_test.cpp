// Steps 1 to 10 on drawn masks: each test changes the decision of one step alone. Then the tip's accuracy.
#include "core/vision/finger/fingertip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/vision/finger/cap.h"
#include "core/vision/finger/triplet_filter.h"
#include "sim/truth/random.h"

namespace enc {
namespace {

using drawn::at_frame;

constexpr int kSide = 240;
// A focal length so long that there is no oblique view; R / B is 0.008 / 0.09.
const RectifiedPair kFlat{1e6, 119.5, 119.5, 0.09, Mat3::Identity()};
constexpr double kMost = 40.0;  // px
constexpr float kTen = 112.5F;  // px of disparity: r = 10 px

// A finger from `tip` back along `along`: pixels that are covered by more than half.
void draw_finger(Mask& mask, Vec3 tip, Vec3 along, double radius, double length) {
  along.normalize();
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      int on = 0;
      for (int i = 0; i < 16; ++i) {
        const Vec3 p = Vec3(x + (i % 4 - 1.5) / 4, y + (i / 4 - 1.5) / 4, 0) - tip;
        const double back = std::clamp(-p.dot(along), 0.0, length);
        on += (p + back * along).squaredNorm() < radius * radius ? 1 : 0;
      }
      if (on > 8) mask.row(y)[x] = 255;
    }
}
Mask upright(double radius = 10.0) {  // its tip points up
  Mask mask(kSide, kSide);
  draw_finger(mask, {120, 80, 0}, {0, -1, 0}, radius, 300);
  return mask;
}

// The counts of one pixel.
StepCounts at(const Mask& mask, int x, int y, const FingertipSpec& spec = {}, float disparity = kTen) {
  FingertipFinder finder(spec, kFlat, kMost, mask.width, mask.height);
  DisparityMap map(mask.width, mask.height);
  map.fill(disparity);
  (void)finder.find(mask, map, {x, y, x + 1, y + 1});
  EXPECT_EQ(finder.counts().visited, 1);
  return finder.counts();
}
Fingertip found(const Mask& mask, const FingertipSpec& spec = {}, float disparity = kTen) {
  FingertipFinder finder(spec, kFlat, kMost, mask.width, mask.height);
  DisparityMap map(mask.width, mask.height);
  map.fill(disparity);
  return finder.find(mask, map, mask.whole());
}

TEST(FingertipSteps, TheMiddleOfTheCapIsACandidate) { EXPECT_EQ(at(upright(), 120, 80).candidates, 1); }

TEST(FingertipSteps, Step1WantsSkin) {
  Mask mask = upright();
  mask.row(80)[120] = 0;
  EXPECT_EQ(at(mask, 120, 80).no_skin, 1);
}

TEST(FingertipSteps, Step2WantsADepth) {
  EXPECT_EQ(at(upright(), 120, 80, {}, std::numeric_limits<float>::quiet_NaN()).no_depth, 1);
  EXPECT_EQ(at(upright(), 120, 80, {}, 0.0F).no_depth, 1);
  EXPECT_EQ(at(upright(), 120, 80, {}, -5.0F).no_depth, 1);
}

// r = K / z = R d / B, and another K.
TEST(FingertipSteps, Step3TakesTheRadiusFromTheDepth) {
  EXPECT_DOUBLE_EQ(found(upright()).radius, 10.0);
  FingertipSpec wider{.scale = 1.25};
  EXPECT_DOUBLE_EQ(found(upright(), wider).radius, 12.5);
  EXPECT_EQ(at(upright(), 120, 80, {}, 20.0F).too_small, 1);   // 1.8 px
  EXPECT_EQ(at(upright(), 120, 80, {}, 500.0F).too_small, 1);  // 44 px: nearer than the nearest
}

// A circle in front of the middle has less skin.
TEST(FingertipSteps, Steps4And5WantAFullCircle) {
  FingertipSpec spec;
  EXPECT_EQ(at(upright(), 120, 73, spec).circle, 1);
  spec.circle_share = 0.5;
  EXPECT_EQ(at(upright(), 120, 73, spec).candidates, 1);
  // The count itself, by brute force.
  const Mask mask = upright();
  int skin = 0, area = 0;
  for (int y = -10; y <= 10; ++y)
    for (int x = -10; x <= 10; ++x)
      if (x * x + y * y <= 100) ++area, skin += mask.at(120 + x, 78 + y) ? 1 : 0;
  spec.circle_share = static_cast<double>(skin) / area;
  EXPECT_EQ(at(mask, 120, 78, spec).candidates, 1);
  spec.circle_share += 1e-9;
  EXPECT_EQ(at(mask, 120, 78, spec).circle, 1);
}

// A ball has no finger behind it.
TEST(FingertipSteps, Steps6And7WantAFinger) {
  Mask ball(kSide, kSide);
  draw_finger(ball, {120, 80, 0}, {0, -1, 0}, 10, 0);
  FingertipSpec spec;
  EXPECT_EQ(at(ball, 120, 80, spec).square, 1);
  spec.square_least = 0.0;
  EXPECT_EQ(at(ball, 120, 80, spec).candidates, 1);
  // The count itself: r2 = 17 px, so that S has 136 pixels; a finger of 2 * 10 px crosses it.
  const Mask mask = upright();
  int along = 0;
  for (int i = -17; i < 17; ++i)
    along += int{mask.at(120 + i, 63)} + mask.at(137, 80 + i) + mask.at(120 - i, 97) + mask.at(103, 80 - i);
  EXPECT_NEAR(along, 20, 1);
  spec.square_least = along / 10.0;
  spec.square_most = along / 10.0;
  EXPECT_EQ(at(mask, 120, 80, spec).candidates, 1);
  spec.square_most = (along - 1) / 10.0;
  EXPECT_EQ(at(mask, 120, 80, spec).square, 1);
  spec.square_most = 4.0;
  spec.square_least = (along + 1) / 10.0;
  EXPECT_EQ(at(mask, 120, 80, spec).square, 1);
}

// Two readings of the printed text. Side: a square of skin alone passes, as its own 4 r2 are not more than 4
// r2. Half the side, with 2 r2 as the least: a straight finger is refused. Ours: the finger passes, the
// square does not.
TEST(FingertipSteps, TheReadingsOfTheSquare) {
  Mask palm(kSide, kSide);
  std::fill(palm.on.begin(), palm.on.end(), std::uint8_t{255});
  FingertipSpec printed;
  printed.pairs = 1e9;  // this step alone
  printed.square_least = 2.0 * printed.square_radii;
  printed.square_most = 4.0 * printed.square_radii + 0.1;  // a pixel: S of r2 = 17 px is rounded to 18
  printed.square = SquareReading::side;
  FingertipSpec ours{.pairs = 1e9};
  FingertipSpec half = printed;
  half.square = SquareReading::half_side;
  printed.square_most = 4.0 * 1.8 + 1e-9;
  EXPECT_EQ(at(palm, 120, 80, printed).candidates, 1);
  EXPECT_EQ(at(upright(), 120, 80, half).square, 1);
  EXPECT_EQ(at(upright(), 120, 80, ours).candidates, 1);
  EXPECT_EQ(at(palm, 120, 80, ours).square, 1);
}

TEST(FingertipSteps, Steps8And9WantTheEndOfAFinger) {
  FingertipSpec spec;
  EXPECT_EQ(at(upright(), 120, 140, spec).pairs, 1);
  spec.pairs = 22.0;
  EXPECT_EQ(at(upright(), 120, 140, spec).candidates, 1);
  // One pair is allowed, a second one is not.
  Mask mask = upright();
  spec.pairs = 1.0;
  mask.row(63)[120] = 255;
  EXPECT_EQ(at(mask, 120, 80, spec).candidates, 1);
  mask.row(63)[121] = 255;
  EXPECT_EQ(at(mask, 120, 80, spec).pairs, 1);
}

// The first of two equal fingers in reading order; the better of two that differ.
TEST(FingertipSteps, Step10TakesTheBestAndOfEqualOnesTheFirst) {
  Mask two(kSide, kSide);
  draw_finger(two, {60, 90, 0}, {0, -1, 0}, 10, 300);
  draw_finger(two, {180, 80, 0}, {0, -1, 0}, 10, 300);
  EXPECT_NEAR(found(two).column, 180, 0.2);
  for (int y = 60; y < kSide; ++y)
    for (int x = 150; x < kSide; x += 5) two.row(y)[x] = 0;
  const Fingertip tip = found(two);
  EXPECT_NEAR(tip.column, 60, 0.2);
  EXPECT_GT(tip.score, 0.95);
}

// A finger that the image cuts off has no known end.
TEST(FingertipSteps, TheEdgeOfTheImageIsNoFingertip) {
  Mask mask(kSide, kSide);
  draw_finger(mask, {-60, 120, 0}, {-1, 0, 0}, 10, 400);
  EXPECT_FALSE(found(mask).found);
  EXPECT_EQ(at(mask, 6, 120).square, 1);
}

TEST(FingertipSteps, CountsAddUp) {
  const Mask mask = upright();
  FingertipFinder finder({}, kFlat, kMost, kSide, kSide);
  DisparityMap map(kSide, kSide);
  map.fill(kTen);
  (void)finder.find(mask, map, mask.whole());
  const StepCounts& n = finder.counts();
  EXPECT_EQ(n.visited, kSide * kSide);
  EXPECT_EQ(n.visited, n.no_skin + n.no_depth + n.too_small + n.circle + n.square + n.pairs + n.candidates);
  EXPECT_GT(n.circle, 0);
  EXPECT_GT(n.pairs, 0);
  EXPECT_EQ(n.candidates, static_cast<std::int64_t>(finder.candidates().size()));
}

// Fingers from all sides, between pixels, widths as at 300 to 900 mm, K right and wrong by a quarter.
TEST(Fingertip, IsFoundToATenthOfAPixel) {
  for (const double scale : {0.75, 1.0, 1.25}) {
    FingertipSpec spec{.scale = scale};
    std::vector<double> errors;
    int missed = 0, rough = 0;
    for (int i = 0; i < 90; ++i) {
      const double angle = 0.0698 * i, radius = 5.0 + 0.17 * i;
      const Vec3 along(std::cos(angle), std::sin(angle), 0),
          tip(120.3 + 0.11 * (i % 7), 119.6 + 0.13 * (i % 5), 0);
      Mask mask(kSide, kSide);
      draw_finger(mask, tip, along, radius, 300);  // it leaves the image
      const Fingertip f = found(mask, spec, static_cast<float>(radius * 0.09 / 0.008));
      if (!f.found) {
        ++missed;
        continue;
      }
      rough += f.fitted ? 0 : 1;
      errors.push_back(std::hypot(f.column - tip.x(), f.row - tip.y()));
      EXPECT_NEAR(f.outline, radius, 0.5) << i;
    }
    std::sort(errors.begin(), errors.end());
    EXPECT_EQ(missed, 0) << scale;
    EXPECT_EQ(rough, 0) << scale;
    EXPECT_LT(errors[errors.size() / 2], 0.15) << scale;
    EXPECT_LT(errors.back(), 0.6) << scale;
    std::printf("K x %.2f: median %.3f px, worst %.3f px\n", scale, errors[errors.size() / 2], errors.back());
  }
}

// Without the fit the middle of the best candidates lies behind the cap, so the fit is needed.
TEST(Fingertip, TheBestCandidatesAloneAreBehindTheCap) {
  FingertipSpec plain{.fit = false};
  const Fingertip rough = found(upright(), plain), fine = found(upright());
  EXPECT_GT(rough.row - 80.0, 1.0);
  EXPECT_LT(std::abs(fine.row - 80.0), 0.4);
  EXPECT_NEAR(fine.along_y, 1.0, 0.02);  // the knuckle is below
}

TEST(Fingertip, AWindowFindsWhatTheFrameFinds) {
  Mask mask = upright(), part(kSide, kSide);
  FingertipFinder finder({}, kFlat, kMost, kSide, kSide);
  DisparityMap map(kSide, kSide);
  map.fill(kTen);
  const Fingertip whole = finder.find(mask, map, mask.whole());
  const Region window{100, 66, 141, 101};
  const int reach = finder.reach(static_cast<double>(kTen));
  for (int y = 0; y < kSide; ++y)  // anything may stand beyond its reach
    for (int x = 0; x < kSide; ++x) {
      const Region near{window.x0 - reach, window.y0 - reach, window.x1 + reach, window.y1 + reach};
      part.row(y)[x] = near.contains(x, y) ? mask.row(y)[x] : 255;
    }
  const Fingertip tip = finder.find(part, map, window);
  EXPECT_EQ(tip.x, whole.x);
  EXPECT_EQ(tip.y, whole.y);
  EXPECT_EQ(tip.column, whole.column);
  EXPECT_EQ(tip.row, whole.row);
  EXPECT_EQ(tip.score, whole.score);
}

TEST(Fingertip, IsNotInAnEmptyOrAFullMask) {
  Mask mask(kSide, kSide);
  EXPECT_FALSE(found(mask).found);
  std::fill(mask.on.begin(), mask.on.end(), std::uint8_t{255});
  EXPECT_FALSE(found(mask).found);
  EXPECT_FALSE(found(Mask(1, 1)).found);
  FingertipFinder finder({}, kFlat, kMost, kSide, kSide);
  DisparityMap map(kSide, kSide);
  EXPECT_FALSE(finder.find(Mask(10, 10), map, {0, 0, 10, 10}).found);
  EXPECT_FALSE(finder.find(mask, map, {500, 500, 600, 600}).found);
}

TEST(Fingertip, ImpossibleSpecsAreRefused) {
  FingertipSpec spec;
  EXPECT_THROW(FingertipFinder(spec, kFlat, 1e6, 10, 10), Error);
  spec.radius = 0.0;
  EXPECT_THROW(FingertipFinder(spec, kFlat, kMost, 10, 10), Error);
  spec = {};
  spec.square_radii = 0.0;
  EXPECT_THROW(FingertipFinder(spec, kFlat, kMost, 10, 10), Error);
}

// The filter in (column, row, disparity): gains by hand, no lag at constant velocity, true covariance.

// Second find 50 ms later, 10 px on: P = 0.09 + 400^2 * 0.0025 + 600^2 * 1.25e-4 / 3 = 415.09,
// P_xv = 400^2 * 0.05 + 600^2 * 0.0025 / 2 = 8450; S = 415.18: K = 0.99978323, K_v = 20.3526.
TEST(TripletFilter, GainsOfTheSecondFindAreThoseWorkedByHand) {
  TrackSpec spec{.acceleration_noise = 600.0, .start_speed = 400.0};
  TripletFilter filter;
  const Vec3 variance(0.09, 0.09, 0.01);
  filter.begin(spec, at_frame(0), {100, 100, 100}, variance);
  filter.predict(spec, at_frame(1));
  EXPECT_NEAR(filter.variance()[0], 415.09, 1e-9);
  filter.correct({110, 100, 100}, variance);
  EXPECT_NEAR(filter.at().column, 100 + 10 * 0.99978323, 1e-6);
  EXPECT_NEAR(filter.rate().column, 10 * 8450 / 415.18, 1e-9);
  EXPECT_EQ(filter.rate().row, 0.0);
}

TEST(TripletFilter, ConstantVelocityIsFollowedWithoutLag) {
  const TrackSpec spec;
  TripletFilter filter;
  const Vec3 variance(0.09, 0.09, 0.02);
  const auto truth = [](int i) { return Triplet{50 + 18.0 * i, 400 - 7.0 * i, 90 + 0.8 * i}; };
  filter.begin(spec, at_frame(0), truth(0), variance);
  for (int i = 1; i < 30; ++i) {
    filter.predict(spec, at_frame(i));
    if (i > 20) {
      EXPECT_LT((filter.at().e() - truth(i).e()).norm(), 1e-6) << i;  // predicted, before it is seen
    }
    filter.correct(truth(i), variance);
  }
  EXPECT_NEAR(filter.rate().column, 360.0, 1e-4);
  EXPECT_NEAR(filter.rate().disparity, 16.0, 1e-4);
}

// Paths that match the filter's model: its stated error is true, on average over seeds.
TEST(TripletFilter, ItsCovarianceIsTrue) {
  const TrackSpec spec;
  const Vec3 variance(0.09, 0.09, 0.0225);
  double before = 0.0, after = 0.0;
  int n = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    sim::Stream random(seed, "way");
    const double h = 0.05;
    Vec3 x(300, 200, 100);
    Vec3 v =
        Vec3(spec.start_speed, spec.start_speed, spec.start_disparity_speed).cwiseProduct(random.normal3());
    const Vec3 q(spec.acceleration_noise, spec.acceleration_noise, spec.disparity_acceleration_noise);
    TripletFilter filter;
    for (int i = 0; i < 25; ++i) {
      if (i > 0) {  // white acceleration within a frame, exactly: a step of v, and half of it in x
        const Vec3 a = q.cwiseProduct(random.normal3()) * std::sqrt(h);
        const Vec3 b = q.cwiseProduct(random.normal3()) * std::sqrt(h * h * h / 12.0);
        x += h * v + 0.5 * h * a + b;
        v += a;
      }
      const Vec3 seen = x + variance.cwiseSqrt().cwiseProduct(random.normal3());
      const Triplet z{seen[0], seen[1], seen[2]};
      if (i == 0) {
        filter.begin(spec, at_frame(0), z, variance);
        continue;
      }
      filter.predict(spec, at_frame(i));
      before += filter.surprise(z, variance);
      filter.correct(z, variance);
      const Vec3 off = filter.at().e() - x;
      after += off.cwiseProduct(off).cwiseQuotient(filter.variance()).sum();
      ++n;
    }
  }
  // Chi squared with 3 n degrees of freedom, n = 1440, corrected for the frames being related: 3 within 8 %.
  EXPECT_NEAR(before / n, 3.0, 0.25);
  EXPECT_NEAR(after / n, 3.0, 0.25);
}

}  // namespace
}  // namespace enc
