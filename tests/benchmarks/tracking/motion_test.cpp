// Scripted motions: speed is the derivative of the way, ends and peaks are as asked for; and what a tracker
// of known age makes of them.
#include "benchmarks/tracking/motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "benchmarks/tracking/prediction_run.h"
#include "tests/support/built.h"

namespace enc::bench::tracking {
namespace {

double greatest_speed(const Motion& motion) {
  constexpr double kStep = 1e-5;
  double fastest = 0.0;
  for (double t = 0.0005; t < motion.duration; t += 0.00173) {
    const MotionPoint here = motion.at(t);
    const Vec3 change = motion.at(t + kStep).position - motion.at(t - kStep).position;
    EXPECT_LT((change / (2.0 * kStep) - here.velocity).norm(), 3e-6) << motion.name << " at " << t;
    fastest = std::max(fastest, here.velocity.norm());
  }
  return fastest;
}

TEST(Motion, MovesWithStopsAreTrapezoids) {
  StopsSpec spec;
  spec.from = Vec3(0, 0, -0.020);
  spec.direction = Vec3(0, 0, 2);
  const Motion motion = moves_with_stops(spec);
  EXPECT_NEAR(greatest_speed(motion), 0.040, 1e-12);
  // A move of 20 mm at 40 mm/s and 0.41 m/s^2: 0.5 s and once the time to speed up, 97.6 ms.
  const double ramp = 0.040 / 0.41;
  EXPECT_NEAR(motion.duration, 9 * 5.0 + 2 * (0.040 / 0.040 + 4 * ramp), 1e-9);
  EXPECT_EQ(motion.at(-1.0).position, Vec3(0, 0, -0.020));
  EXPECT_NEAR((motion.at(0.5 * motion.duration).position - Vec3(0, 0, 0.020)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((motion.at(motion.duration + 1.0).position - Vec3(0, 0, -0.020)).norm(), 0.0, 1e-15);
}

TEST(Motion, AShortMoveDoesNotReachItsSpeed) {
  StopsSpec spec;
  spec.stops = {0.0, 0.001};
  EXPECT_NEAR(greatest_speed(moves_with_stops(spec)), std::sqrt(0.001 * 0.41), 0.41 * 0.00173);  // samples
}

TEST(Motion, ReachesHaveTheirPeakAndComeBack) {
  for (const ReachShape* shape : {&minimum_jerk(), &early_peak(), &two_movements()}) {
    EXPECT_NEAR(shape->way(0.0), 0.0, 1e-15);
    EXPECT_NEAR(shape->way(1.0), 1.0, 1e-12) << shape->name;
    const Motion motion = reaches(*shape, {});
    EXPECT_NEAR(greatest_speed(motion), 0.040, 1e-5) << shape->name;
    EXPECT_NEAR(motion.at(motion.duration).position.norm(), 0.0, 1e-15) << shape->name;
  }
}

TEST(Motion, TremorHasItsSizeAndAStopIsAStop) {
  const Motion shaking = with_tremor(at_rest(100.0), 0.05e-3, 8.0, 12.0, 3);
  double sum = 0.0;
  for (int ms = 0; ms < 100000; ++ms) sum += std::pow(shaking.at(1e-3 * ms).position.x(), 2);
  EXPECT_NEAR(std::sqrt(sum / 1e5), 0.05e-3, 0.005e-3);
  greatest_speed(shaking);
  const Motion hit = stopped(swing(Vec3(0.003, 0, 0), 2.0, 5.0), 0.05);
  EXPECT_EQ(hit.at(0.06).position, hit.at(4.0).position);
  EXPECT_EQ(hit.at(0.06).velocity.norm(), 0.0);
}

// ---- through the tracker
// -------------------------------------------------------------------------------------------

std::array<TipErrors, 3> errors_with(const std::vector<std::string>& more) {
  std::vector<std::string> set{"truth.tracker.bias_mm=[0,0,0]", "truth.tracker.noise_mm=[0,0,0]",
                               "truth.tracker.marker_noise_mm=0", "truth.tracker.udp_delay_ms=0",
                               "truth.tracker.packets=event"};
  set.insert(set.end(), more.begin(), more.end());
  const models::Setup setup =
      models::load(tests::source_dir() + "/models/scenes/tennis_ball.toml", "sim", set);
  StopsSpec spec;
  spec.stops = {0.0, 0.080};
  spec.dwell = 0.5;
  spec.both_ways = false;
  const PredictionRun run{moves_with_stops(spec), setup.twin.tracker, 1, true, 0.8, 2.4};  // at an even speed
  return predicted_run(prepare(setup.scene, setup.rig), pose_of<'W', 'C'>(setup.twin.frames.W_C), run);
}

// Held, the tool is behind by its speed times the age of its pose: a longer latency shows in full.
TEST(PredictedRun, HoldingIsBehindByTheAge) {
  const TipErrors early = errors_with({"truth.tracker.latency_ms=0"})[0];
  const TipErrors late = errors_with({"truth.tracker.latency_ms=10"})[0];
  EXPECT_NEAR(late.peak - early.peak, 0.040 * 0.010, 0.040 * 0.001);
  EXPECT_NEAR(late.at_packets - early.at_packets, 0.040 * 0.010, 0.040 * 0.001);
  EXPECT_NEAR(early.at_ticks - early.at_packets, 0.040 * 0.5 / 120.0,
              0.040 * 0.001);  // half a frame on average
}

// At an even speed prediction takes all of that away, and puts a wrong stamp's share in.
TEST(PredictedRun, PredictionLeavesWhatTheStampsGetWrong) {
  const std::array<TipErrors, 3> right = errors_with({});
  const std::array<TipErrors, 3> wrong = errors_with({"truth.tracker.stamp_error_ms=3"});
  const std::array<TipErrors, 3> known =
      errors_with({"truth.tracker.stamp_error_ms=3", "rig.tracker.stamp_late_ms=3"});
  for (const std::size_t k : {1U, 2U}) {
    EXPECT_LT(right[k].at_ticks, 20e-6);
    EXPECT_NEAR(wrong[k].at_ticks, 0.040 * 0.003, 20e-6);
    EXPECT_NEAR(known[k].at_ticks, right[k].at_ticks, 1e-9);
  }
}

}  // namespace
}  // namespace enc::bench::tracking
