// The simulated force sensor: several readings in a sample, and a zero that drifts from push to push.
#include "sim/plants/force_plant.h"

#include <cmath>

#include <gtest/gtest.h>

#include "sim/bodies/pusher.h"

namespace enc::sim {
namespace {

const Wrench kNothing{Vec<'F'>::zero(), Vec<'F'>::zero()};

// N rms of what a sensor without zero error reads of nothing.
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

  truth.drift_ahead = 0.0;  // the same, at once
  ForcePlant sudden(truth, 5);
  sudden.begin_push();
  EXPECT_GT(sudden.zero().norm(), 1e-3);
}

// That a push comes is told once for each, however long before.
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

}  // namespace
}  // namespace enc::sim
