#include "benchmarks/tracking/prediction_run.h"

#include <algorithm>
#include <cmath>

#include "core/control/stages/walk.h"
#include "sim/plants/tracker_plant.h"

namespace enc::bench::tracking {
namespace {

constexpr double kSettle = 0.5;  // s at rest before the motion: the filter knows the tool by then

struct Sums {
  double packets = 0.0, ticks = 0.0;
  std::int64_t packet_count = 0, tick_count = 0;
};

// One core that sees the tracker alone, in follow: nothing is away, so that a drop-out has to be caught up.
struct Watcher {
  Scene scene;
  State state;
  Sums sums;
  TipErrors errors;
  Vec3 before = Vec3::Constant(kUnset);  // the error one tick ago, m

  Watcher(const Scene& from, Prediction prediction) : scene(from) {
    scene.clamped_tool = -1;
    scene.tracker.prediction = prediction;
    state.mode = Mode::follow;
  }
  // The error of this tick, or unset where the tool was not seen yet.
  Vec3 see(const Tick& tick, const Inputs& in, const Vec3& truth) {
    stages::Walk walk(scene, tick, in);
    stages::track_tool(walk, state, false);
    return walk.tool_tip.e() - truth;
  }
  void count(const Vec3& error, bool news) {
    if (!error.allFinite()) return;
    sums.ticks += error.squaredNorm();
    ++sums.tick_count;
    if (news) {
      sums.packets += error.squaredNorm();
      ++sums.packet_count;
    }
    errors.peak = std::max(errors.peak, error.cwiseAbs().maxCoeff());
    if (before.allFinite()) errors.largest_step = std::max(errors.largest_step, (error - before).norm());
  }
  [[nodiscard]] TipErrors result() const {
    TipErrors done = errors;
    done.at_packets = std::sqrt(sums.packets / static_cast<double>(sums.packet_count));
    done.at_ticks = std::sqrt(sums.ticks / static_cast<double>(sums.tick_count));
    return done;
  }
};

}  // namespace

std::array<TipErrors, 3> predicted_run(const Scene& scene, const Pose<'W', 'C'>& true_X_WC,
                                       const PredictionRun& run, TipTrace* trace) {
  std::array<Watcher, 3> watchers{Watcher(scene, kPredictions[0]), Watcher(scene, kPredictions[1]),
                                  Watcher(scene, kPredictions[2])};
  sim::TrackerTruth its = run.truth;
  its.blackout_at += kSettle;
  sim::TrackerPlant tracker(its, true_X_WC, run.seed);
  const Vec3 tip_T = scene.tools.front().tip.centre.e();
  const double end = kSettle + std::min(run.motion.duration, run.to);
  Inputs in;
  Tick tick;
  tick.dt = from_seconds(scene.dt);
  for (tick.index = 0; seconds(tick.t.time_since_epoch()) <= end; ++tick.index, tick.t += tick.dt) {
    const double t = seconds(tick.t.time_since_epoch()) - kSettle;
    const MotionPoint truth = run.motion.at(t);
    tracker.advance(tick.t, 0, Pose<'W', 'T'>(Quat::Identity(), Vec3(truth.position - tip_T)));
    const bool news = tracker.poll(in.tool);
    const bool counts = t >= run.from && (!run.moving_only || truth.velocity != Vec3(0, 0, 0));
    if (trace != nullptr && t >= run.from) trace->time.push_back(t);
    for (std::size_t i = 0; i < watchers.size(); ++i) {
      const Vec3 error = watchers[i].see(tick, in, truth.position);
      if (counts) watchers[i].count(error, news);
      watchers[i].before = error;
      if (trace != nullptr && t >= run.from) trace->error[i].push_back(error.x());
    }
  }
  return {watchers[0].result(), watchers[1].result(), watchers[2].result()};
}

}  // namespace enc::bench::tracking
