// The simulated sensors.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "sim/bodies/pusher.h"
#include "sim/plants/device_plants.h"
#include "sim/plants/tracker_plant.h"

namespace enc::sim {
namespace {

// The simulated force sensor: several readings in a sample, and a zero that drifts from push to push.

const Wrench kNothing{Vec<'F'>::zero(), Vec<'F'>::zero()};

// N rms of a sensor without zero error and without load.
double rms(std::int64_t oversampling) {
  ForceTruth truth;
  truth.zero = truth.drift = 0.0;
  truth.oversampling = oversampling;
  ForcePlant plant(truth, 3);
  double sum = 0.0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    plant.measure(Time(), 1e-3, kNothing, Vec<'F'>::zero());
    sum += plant.sample().value.force.xyz[2] * plant.sample().value.force.xyz[2];
  }
  return std::sqrt(sum / kSamples);
}

TEST(ForcePlant, OversamplingDividesNoiseByTheRoot) {
  // One reading: noise 0.0125 N and steps of 0.025 N (uniform: 0.025 / sqrt(12)).
  const double one = std::hypot(0.0125, 0.025 / std::sqrt(12.0));
  EXPECT_NEAR(rms(1), one, 0.03 * one);
  EXPECT_NEAR(rms(8), one / std::sqrt(8.0), 0.03 * one);
}

TEST(ForcePlant, TheZeroDriftsBeforeAPush) {
  ForceTruth truth;
  truth.zero = truth.drift = 0.0;
  truth.push_drift = 0.02;
  truth.drift_ahead = 1.0;
  ForcePlant plant(truth, 5);
  plant.begin_push();
  EXPECT_EQ(plant.zero().norm(), 0.0);
  for (int i = 0; i < 500; ++i) plant.measure(Time(), 1e-3, kNothing, Vec<'F'>::zero());
  const Vec<'F'> half = plant.zero();
  for (int i = 0; i < 700; ++i) plant.measure(Time(), 1e-3, kNothing, Vec<'F'>::zero());
  EXPECT_GT(half.norm(), 1e-3);
  EXPECT_NEAR((plant.zero() - 2.0 * half).norm(), 0.0, 1e-12);

  truth.drift_ahead = 0.0;  // equal, at once
  ForcePlant sudden(truth, 5);
  sudden.begin_push();
  EXPECT_GT(sudden.zero().norm(), 1e-3);
}

// Each push is announced once, at any time before.
TEST(ForcePlant, APushIsNearOnce) {
  PusherSpec spec;
  spec.ramp_time = spec.hold_time = 0.1;
  spec.rest_time = 0.5;
  spec.repeats = 2;
  for (const double ahead : {0.0, 0.1234, 0.5, 3.0}) {
    Pusher pusher(spec, PusherTruth{}, {{Point<'W'>(0, 0, 0.0), Vec<'W'>(0, 0, 1)}, 0.01, 1.0}, 0.005, 1);
    int told = 0;
    for (int i = 0; i < 2000; ++i) {
      told += pusher.near(i * 1e-3, 1e-3, ahead) ? 1 : 0;
      pusher.act(i * 1e-3, 1e-3, Point<'W'>(0, 0, -0.005), Vec<'W'>::zero());
    }
    EXPECT_EQ(told, 2) << ahead << " s";
  }
}

// The tracker that identifies a tool by its markers, with a pose as good as they allow.

// The marker sets of models/scenes/session.toml.
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
      Measurement<TrackedTool> sample;
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

// Without marker noise the tracker draws no random number for markers: its pose equals that of a tracker
// without them.
TEST(TrackerPlant, WithoutNoiseOfMarkersTheToolIsKnown) {
  TrackerTruth truth = with_noise(kUnset);
  TrackerPlant with(truth, kCamera, 7, kTools), without(truth, kCamera, 7);
  for (std::int64_t i = 1; i <= 1000; ++i)
    for (TrackerPlant* plant : {&with, &without})
      plant->advance(Time(i * Duration(1'000'000)), 0, Pose<'W', 'T'>::shift(0, 0, 0.1));
  Measurement<TrackedTool> a, b;
  ASSERT_TRUE(with.poll(a));
  ASSERT_TRUE(without.poll(b));
  EXPECT_EQ(a.value.X_CT.p(), b.value.X_CT.p());
}

// The stereo head by hand: the image of a point, points outside, the size of a pixel at 0.6 m, and the noise
// that averaging removes.

CameraTruth exact() {
  CameraTruth truth;
  truth.matching = truth.pointing = truth.standing = truth.disparity_step = 0.0;
  return truth;
}

TEST(StereoNoise, APointByHand) {
  // A pixel at 0.721 m is 1 mm wide and the disparity 0.09 * 721 / 0.721 = 90 px.
  const StereoPoints eyes(CameraTruth{}, 1);
  const auto pixel = eyes.project({0.010, -0.020, 0.721});
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->column, 319.5 + 10.0, 1e-9);
  EXPECT_NEAR(pixel->row, 239.5 - 20.0, 1e-9);
  EXPECT_NEAR(pixel->disparity, 90.0, 1e-9);
  EXPECT_NEAR((eyes.triangulate(*pixel) - Point<'C'>(0.010, -0.020, 0.721)).norm(), 0.0, 1e-12);
}

TEST(StereoNoise, SeesOnlyWhatIsInBothImages) {
  const StereoPoints eyes(CameraTruth{}, 1);
  const double z = 0.721;
  EXPECT_FALSE(eyes.project({0, 0, -z}));
  EXPECT_FALSE(eyes.project({0, 0, 0}));
  EXPECT_FALSE(eyes.project({kUnset, 0, z}));
  EXPECT_TRUE(eyes.project({0.319, 0, z}));
  EXPECT_FALSE(eyes.project({0.320, 0, z}));  // right of the left image
  EXPECT_TRUE(eyes.project({-0.229, 0, z}));  // 229 px left of the middle, and 90 more in the right image
  EXPECT_FALSE(eyes.project({-0.230, 0, z}));
  EXPECT_TRUE(eyes.project({0, 0.239, z}));
  EXPECT_FALSE(eyes.project({0, -0.240, z}));
  StereoPoints seeing(CameraTruth{}, 1);
  EXPECT_FALSE(seeing.see({0, 0, -z}));
}

TEST(StereoNoise, WithoutNoiseTheStepOfTheDisparityIsLeft) {
  StereoPoints without(exact(), 1);
  const Point<'C'> p(0.05, 0.03, 0.6);
  EXPECT_NEAR((*without.see(p) - p).norm(), 0.0, 1e-12);
  CameraTruth truth = exact();
  truth.disparity_step = 1.0 / 16.0;
  StereoPoints stepped(truth, 1);
  for (double z = 0.5; z < 0.7; z += 0.0007) {
    // Half a step, in depth: z^2 / (f b) / 32.
    const double most = z * z / (721.0 * 0.09) / 32.0 * 1.001;
    EXPECT_LE(std::abs(stepped.see({0, 0, z})->e().z() - z), most) << z;
  }
}

// 0.2 px at 0.6 m: 0.36 / 64.89 * 0.2 = 1.11 mm of depth, 0.15 px: 0.125 mm aside.
TEST(StereoNoise, ScattersAsFirstOrderSays) {
  CameraTruth truth{.standing = 0.0};
  StereoPoints eyes(truth, 7);
  const Point<'C'> p(0.0, 0.1, 0.6);
  const Vec<'C'> theory = eyes.scatter(p);
  EXPECT_NEAR(theory.e().z(), 1.114e-3, 2e-6);
  EXPECT_NEAR(theory.e().x(), 0.125e-3, 1e-6);
  EXPECT_NEAR(theory.e().y(), std::hypot(0.125e-3, 1.114e-3 / 6.0), 2e-6);
  constexpr int kFrames = 20000;
  Vec3 sum = Vec3::Zero(), square = Vec3::Zero();
  for (int i = 0; i < kFrames; ++i) {
    const Vec3 error = (*eyes.see(p) - p).e();
    sum += error / kFrames;
    square += error.cwiseAbs2() / kFrames;
  }
  for (Eigen::Index a = 0; a < 3; ++a) {
    EXPECT_NEAR(std::sqrt(square(a)) / theory.e()(a), 1.0, 0.03) << a;
    EXPECT_LT(std::abs(sum(a)), 4.0 * theory.e()(a) / std::sqrt(kFrames) + 5e-6) << a;
  }
}

TEST(StereoNoise, WhatStandsIsNotAveragedAway) {
  CameraTruth truth = exact();
  truth.standing = 0.05;
  StereoPoints eyes(truth, 3);
  const Point<'C'> p(0.0, 0.0, 0.6);
  const Point<'C'> first = *eyes.see(p);
  EXPECT_GT((first - p).norm(), 1e-6);
  for (int i = 0; i < 10; ++i) EXPECT_EQ((*eyes.see(p) - first).norm(), 0.0);
  eyes.move();
  EXPECT_GT((*eyes.see(p) - first).norm(), 1e-6);
}

TEST(StereoNoise, ASeedRepeats) {
  StereoPoints one(CameraTruth{}, 11), same(CameraTruth{}, 11), other(CameraTruth{}, 12);
  const Point<'C'> p(0.01, 0.02, 0.5), a = *one.see(p);
  EXPECT_EQ(a.xyz, same.see(p)->xyz);
  EXPECT_NE(a.xyz, other.see(p)->xyz);
}

}  // namespace
}  // namespace enc::sim
