// Scripted motions of a tool's tip as functions of time, for measures that need no simulated hand: the
// paper's moves with stops [VHMR 4.1], reaches of several shapes, a press, tremor, a sudden stop. Also their
// error after the simulated tracker and the core, without a machine: the distance between the tip and the
// core's estimate.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "core/control/scene/scene.h"
#include "models/setup/scene_file.h"

namespace enc::bench::tracking {

struct MotionPoint {
  Vec3 position{0, 0, 0}, velocity{0, 0, 0};  // m, m/s
};

// `at` takes s since the start and accepts times beyond both ends, where the tool rests.
struct Motion {
  std::string name;
  double duration = 0.0;  // s
  std::function<MotionPoint(double)> at;
};

// Moves from stop to stop at a speed, in straight lines [VHMR 4.1]: dwell, move, dwell, ... The last dwell is
// whole.
struct StopsSpec {
  Vec3 from{0, 0, 0};                                          // m, of stop 0
  Vec3 direction{1, 0, 0};                                     // direction of the stops
  std::vector<double> stops{0.0, 0.005, 0.010, 0.020, 0.040};  // m
  double speed = 0.040;                                        // m/s
  double acceleration = 0.41;  // m/s^2, both ends of a move; a short move does not reach its speed
  double dwell = 5.0;          // s
  bool both_ways = true;       // and back over the same stops
};
[[nodiscard]] Motion moves_with_stops(const StopsSpec& spec);

// The shape of a reach: path and speed from 0 to 1 in unit time, and its highest speed.
struct ReachShape {
  const char* name;
  double peak;
  double (*way)(double s);
  double (*speed)(double s);
};
// Minimum jerk (Flash and Hogan 1985); early peak, s^2 (1 - s)^4; a main movement and a correction,
// overlapping.
[[nodiscard]] const ReachShape& minimum_jerk();
[[nodiscard]] const ReachShape& early_peak();
[[nodiscard]] const ReachShape& two_movements();

// Moves there and back, `times` times, with a rest after each way.
struct ReachSpec {
  Vec3 way{0.020, 0, 0};      // m
  double peak_speed = 0.040;  // m/s
  double rest = 0.3;          // s
  int times = 4;
};
[[nodiscard]] Motion reaches(const ReachShape& shape, const ReachSpec& spec);

[[nodiscard]] Motion at_rest(double duration);
// amplitude * sin(2 pi rate t)
[[nodiscard]] Motion swing(const Vec3& amplitude, double rate, double duration);
// Adds a tremor of `rms` along each axis (m) to the motion, of 16 waves between two rates, Hz, with phases
// from the seed.
[[nodiscard]] Motion with_tremor(const Motion& motion, double rms, double lowest, double highest,
                                 std::uint64_t seed);
// The motion until a collision at `at`, s; from then on it stands still.
[[nodiscard]] Motion stopped(const Motion& motion, double at);

inline constexpr std::array<Prediction, 3> kPredictions{Prediction::hold, Prediction::constant_velocity,
                                                        Prediction::constant_acceleration};

// A motion, the tracker's properties on it, and the part of it that counts.
struct PredictionRun {
  Motion motion;
  sim::TrackerTruth truth;  // its black-out counts from the motion's start
  std::uint64_t seed = 1;
  bool moving_only = false;                                         // without the stops
  double from = 0.0, to = std::numeric_limits<double>::infinity();  // s since the motion's start
};

struct TipErrors {
  double at_packets = kUnset;  // m, rms of the distance, on ticks with a new pose
  double at_ticks = kUnset;    // m, rms of the distance on every tick
  double peak = 0.0;           // m, largest along an axis, on every tick
  double largest_step = 0.0;   // m: step of the prediction beyond the tool's own in a tick
};
// Errors along x on each tick, for a plot over time.
struct TipTrace {
  std::vector<double> time;                  // s since the motion's start
  std::array<std::vector<double>, 3> error;  // m, for each prediction
};

// Runs the motion with each prediction on equal packets. The scene has the core's settings; `trace` may be
// null.
[[nodiscard]] std::array<TipErrors, 3> predicted_run(const Scene& scene, const Pose<'W', 'C'>& true_X_WC,
                                                     const PredictionRun& run, TipTrace* trace = nullptr);

}  // namespace enc::bench::tracking
