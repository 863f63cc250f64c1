// The tracker that finds a tool by its markers: which one, and as good a pose as they allow.
#include "sim/plants/tracker_plant.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace enc::sim {
namespace {

// Those of models/scenes/session.toml.
const std::vector<std::vector<Vec3>> kTools{
    {{0, 0, 0}, {0.052, 0, 0}, {0, 0.041, 0}, {-0.017, -0.030, 0.012}},
    {{0, 0, 0}, {0.061, 0, 0}, {0, 0.034, 0}, {-0.025, -0.022, 0.008}}};
const Pose<'W', 'C'> kCamera({0.8, 0.6, 0, 0}, Vec3(0, -0.9, 0.6));

TrackerTruth with_noise(double noise) {
  TrackerTruth truth;
  truth.packets = Packets::event;
  truth.bias = Vec3(0.1e-3, 0.2e-3, 0.3e-3);
  truth.noise = Vec3::Zero();
  truth.marker_noise = noise;
  return truth;
}

Vec3 middle(const std::vector<Vec3>& markers) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& marker : markers) sum += marker / static_cast<double>(markers.size());
  return sum;
}

// The middle of four markers is known twice as well as one of them; it is off by the bias.
TEST(TrackerPlant, RecognisesTheToolByItsMarkersAndItsPoseIsAsGoodAsTheyAllow) {
  const Pose<'W', 'T'> X_WT({0.5, 0.5, -0.5, 0.5}, Vec3(0.02, 0.01, 0.15));
  for (const double noise : {0.0, 0.3e-3}) {
    TrackerPlant plant(with_noise(noise), kCamera, 7, kTools);
    int news = 0;
    Vec3 sum = Vec3::Zero(), squares = Vec3::Zero();
    for (std::int64_t i = 1; i <= 20'000; ++i) {
      plant.advance(Time(i * Duration(1'000'000)), 1, X_WT);
      Stamped<TrackedTool> sample;
      if (!plant.poll(sample)) continue;
      ASSERT_EQ(sample.value.tool, 1);
      const Point<'T'> centre(middle(kTools[1]));
      const Vec3 off = (kCamera * (sample.value.X_CT * centre)).e() - (X_WT * centre).e();
      sum += off;
      squares += off.cwiseProduct(off);
      ++news;
    }
    EXPECT_GT(news, 2300);
    const Vec3 mean = sum / news,
               spread = (squares / news - mean.cwiseProduct(mean)).cwiseMax(0.0).cwiseSqrt();
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(mean[axis], with_noise(noise).bias[axis], 0.01e-3);
      EXPECT_NEAR(spread[axis], noise / 2, 0.05 * noise / 2 + 1e-9);
    }
  }
}

// Nothing else is drawn then, and without it nothing of it.
TEST(TrackerPlant, WithoutNoiseOfMarkersTheToolIsKnown) {
  TrackerTruth truth = with_noise(kUnset);
  TrackerPlant with(truth, kCamera, 7, kTools), without(truth, kCamera, 7);
  for (std::int64_t i = 1; i <= 1000; ++i)
    for (TrackerPlant* plant : {&with, &without})
      plant->advance(Time(i * Duration(1'000'000)), 0, Pose<'W', 'T'>::shift(0, 0, 0.1));
  Stamped<TrackedTool> a, b;
  ASSERT_TRUE(with.poll(a));
  ASSERT_TRUE(without.poll(b));
  EXPECT_EQ(a.value.X_CT.p(), b.value.X_CT.p());
}

}  // namespace
}  // namespace enc::sim
