#include "benchmarks/tracking/motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/control/stages/step_context.h"
#include "core/control/track/reach.h"
#include "sim/plants/tracker_plant.h"
#include "sim/truth/random.h"

namespace enc::bench::tracking {
namespace {

// A straight move that begins at `start`: accelerates, runs, decelerates equally.
struct Leg {
  double start, from, to;           // s, m, m
  double acceleration, ramp, even;  // m/s^2, s, s

  Leg(double start_, double from_, double to_, double speed, double acceleration_)
      : start(start_), from(from_), to(to_), acceleration(acceleration_) {
    const double way = std::abs(to - from);
    const double fastest = std::min(speed, std::sqrt(way * acceleration));
    ramp = fastest / acceleration;
    even = fastest > 0.0 ? way / fastest - ramp : 0.0;
  }
  [[nodiscard]] double length() const { return 2.0 * ramp + even; }
  // Place and speed at t since the experiment's start.
  [[nodiscard]] std::pair<double, double> at(double t) const {
    const double sign = to >= from ? 1.0 : -1.0;
    const double s = t - start;
    if (s <= 0.0) return {from, 0.0};
    if (s >= length()) return {to, 0.0};
    const double left = length() - s;
    const double top = acceleration * ramp;
    if (s < ramp) return {from + sign * 0.5 * acceleration * s * s, sign * acceleration * s};
    if (left < ramp) return {to - sign * 0.5 * acceleration * left * left, sign * acceleration * left};
    return {from + sign * (0.5 * top * ramp + top * (s - ramp)), sign * top};
  }
};

double minimum_jerk_way(double s) { return MinimumJerk(s).x; }
double minimum_jerk_speed(double s) { return MinimumJerk(s).v; }

double early_peak_way(double s) {
  return s * s * s * (35.0 + s * (-105.0 + s * (126.0 + s * (-70.0 + 15.0 * s))));
}
double early_peak_speed(double s) {
  const double rest = (1.0 - s) * (1.0 - s);
  return 105.0 * s * s * rest * rest;
}

// 80 % of the way in the first 70 % of the time; the rest starts at half time.
constexpr double kFirstWay = 0.8, kFirstTime = 0.7, kSecondStart = 0.5;
double two_movements_way(double s) {
  const double first = std::clamp(s / kFirstTime, 0.0, 1.0);
  const double second = std::clamp((s - kSecondStart) / (1.0 - kSecondStart), 0.0, 1.0);
  return kFirstWay * minimum_jerk_way(first) + (1.0 - kFirstWay) * minimum_jerk_way(second);
}
double two_movements_speed(double s) {
  const double first = std::clamp(s / kFirstTime, 0.0, 1.0);
  const double second = std::clamp((s - kSecondStart) / (1.0 - kSecondStart), 0.0, 1.0);
  return kFirstWay / kFirstTime * minimum_jerk_speed(first) +
         (1.0 - kFirstWay) / (1.0 - kSecondStart) * minimum_jerk_speed(second);
}

struct Wave {
  double rate;     // rad/s
  Vec3 amplitude;  // m
  Vec3 phase;      // rad
};

constexpr double kSettle = 0.5;  // s at rest before the motion: the filter settles on the tool

struct Sums {
  double packets = 0.0, ticks = 0.0;
  std::int64_t packet_count = 0, tick_count = 0;
};

// One core with the tracker as its only input, in follow: the tool never counts as away, so the core must
// catch up after a drop-out.
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
  // The error of this tick, unset before the first pose of the tool.
  Vec3 see(const Tick& tick, const Inputs& in, const Vec3& truth) {
    stages::StepContext step_context(scene, tick, in);
    stages::track_tool(step_context, state);
    return step_context.tool_tip.e() - truth;
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

Motion moves_with_stops(const StopsSpec& spec) {
  std::vector<double> stops = spec.stops;
  if (spec.both_ways && !stops.empty()) stops.insert(stops.end(), spec.stops.rbegin() + 1, spec.stops.rend());
  std::vector<Leg> legs;
  double t = spec.dwell;
  for (std::size_t i = 1; i < stops.size(); ++i) {
    legs.emplace_back(t, stops[i - 1], stops[i], spec.speed, spec.acceleration);
    t += legs.back().length() + spec.dwell;
  }
  const double first = stops.empty() ? 0.0 : stops.front();
  const auto at = [legs, first, from = spec.from, direction = Vec3(spec.direction.normalized())](double now) {
    const auto next = std::upper_bound(legs.begin(), legs.end(), now,
                                       [](double s, const Leg& leg) { return s < leg.start; });
    const auto [x, v] = next == legs.begin() ? std::pair(first, 0.0) : (next - 1)->at(now);
    return MotionPoint{from + x * direction, v * direction};
  };
  return {"moves with stops", t, at};
}

const ReachShape& minimum_jerk() {
  static constexpr ReachShape kShape{"minimum jerk", 1.875, minimum_jerk_way, minimum_jerk_speed};
  return kShape;
}

const ReachShape& early_peak() {
  static constexpr ReachShape kShape{"early peak", 105.0 * 16.0 / 729.0, early_peak_way, early_peak_speed};
  return kShape;
}

const ReachShape& two_movements() {
  static constexpr ReachShape kShape{"two movements", kFirstWay / kFirstTime * 1.875, two_movements_way,
                                     two_movements_speed};
  return kShape;
}

Motion reaches(const ReachShape& shape, const ReachSpec& spec) {
  const double time = shape.peak * spec.way.norm() / spec.peak_speed;
  const double each = time + spec.rest;
  const auto at = [shape, spec, time, each](double now) {
    const double last = 2.0 * spec.times - 1.0;
    const double n = std::clamp(std::floor(now / each), 0.0, last);
    const double s = std::clamp((now - n * each) / time, 0.0, 1.0);
    const bool back = std::fmod(n, 2.0) != 0.0;
    const double x = shape.way(s);
    const double v = shape.speed(s) / time;
    return MotionPoint{(back ? 1.0 - x : x) * spec.way, (back ? -v : v) * spec.way};
  };
  return {shape.name, 2.0 * spec.times * each, at};
}

Motion at_rest(double duration) {
  return {"rest", duration, [](double) { return MotionPoint{}; }};
}

Motion swing(const Vec3& amplitude, double rate, double duration) {
  const double w = 2.0 * std::numbers::pi * rate;
  const auto at = [amplitude, w, duration](double t) {
    const double s = std::clamp(t, 0.0, duration);
    const bool inside = s == t;
    return MotionPoint{std::sin(w * s) * amplitude,
                       inside ? Vec3(w * std::cos(w * s) * amplitude) : Vec3(0, 0, 0)};
  };
  return {"swing", duration, at};
}

Motion with_tremor(const Motion& motion, double rms, double lowest, double highest, std::uint64_t seed) {
  constexpr std::size_t kWaves = 16;
  std::array<Wave, kWaves> waves;
  sim::Stream random(seed, "tremor");
  for (Wave& wave : waves) {
    wave.rate = 2.0 * std::numbers::pi * (lowest + (highest - lowest) * random.uniform());
    wave.amplitude = Vec3::Constant(rms * std::sqrt(2.0 / kWaves));
    for (double& phase : wave.phase) phase = 2.0 * std::numbers::pi * random.uniform();
  }
  auto at = [waves, base = motion.at](double t) {
    MotionPoint point = base(t);
    for (const Wave& wave : waves) {
      const Eigen::Array3d angle = wave.rate * t + wave.phase.array();
      point.position += wave.amplitude.cwiseProduct(angle.sin().matrix());
      point.velocity += wave.rate * wave.amplitude.cwiseProduct(angle.cos().matrix());
    }
    return point;
  };
  return {motion.name + ", tremor", motion.duration, at};
}

Motion stopped(const Motion& motion, double at) {
  const Vec3 place = motion.at(at).position;
  return {motion.name + ", stopped", motion.duration, [at, place, base = motion.at](double t) {
            return t < at ? base(t) : MotionPoint{place, Vec3(0, 0, 0)};
          }};
}

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
