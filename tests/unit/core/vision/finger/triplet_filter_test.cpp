// The filter in (column, row, disparity): gains by hand, no lag at constant velocity, covariance that is
// true.
#include "core/vision/finger/triplet_filter.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sim/truth/random.h"

namespace enc {
namespace {

using drawn::at_frame;

// Second find 50 ms later, 10 px on: P = 0.09 + 400^2 * 0.0025 + 600^2 * 1.25e-4 / 3 = 415.09,
// P_xv = 400^2 * 0.05 + 600^2 * 0.0025 / 2 = 8450; S = 415.18: K = 0.99978323, K_v = 20.3526.
TEST(TripletFilter, GainsOfTheSecondFindAreThoseWorkedByHand) {
  TrackSpec spec;
  spec.acceleration_noise = 600.0;
  spec.start_speed = 400.0;
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
      EXPECT_LT((filter.at().e() - truth(i).e()).norm(), 1e-6) << i;  // foreseen, before it is seen
    }
    filter.correct(truth(i), variance);
  }
  EXPECT_NEAR(filter.rate().column, 360.0, 1e-4);
  EXPECT_NEAR(filter.rate().disparity, 16.0, 1e-4);
}

// Ways that the filter believes in: what it says of its own error is true, on average over seeds.
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
      if (i > 0) {  // white acceleration within a frame, exactly: a step of v and the half of it that x gets
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
