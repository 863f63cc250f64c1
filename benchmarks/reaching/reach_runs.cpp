#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/kit/load_scene.h"
#include "benchmarks/kit/parallel.h"
#include "benchmarks/kit/statistics.h"
#include "benchmarks/reaching/reaching.h"
#include "core/base/error.h"

namespace enc::bench::reaching {
namespace {

ReachRan run_one(const BenchContext& context, const ReachRun& run) {
  ReachMeasure measure;
  trial::TrialOptions options;
  options.seed = run.seed;
  options.watch = [&](const trial::Glance& glance) { measure.see(glance); };
  models::Setup setup = load_scene(context, run.scene, run.set);
  if (run.random > 0) reach_at_random(setup, run.random);
  trial::Trial trial(std::move(setup), options);
  const double start = thread_seconds();
  const trial::TrialResult done = trial.run();
  if (done.diverged_at >= 0) throw Error("a simulation of reaches diverged: " + done.divergence);
  return {measure.reaches(), measure.far_speed(), done.simulated, thread_seconds() - start};
}

// Someone who presses the wall quickly and not deep.
Settings quick_presses(int count) {
  return {"user.kind=\"press_release\"",
          "user.depth_mm=4",
          "user.press_s=0.3",
          "user.hold_s=0.1",
          "user.release_s=0.3",
          "user.rest_s=0.5",
          "user.approach_from_mm=170",
          fmt::format("user.repeats={}", count)};
}

template <class Value>
std::vector<double> of_each(const std::vector<ReachOutcome>& reaches, Value value) {
  std::vector<double> all;
  for (const ReachOutcome& r : reaches)
    if (!std::isnan(r.met)) all.push_back(value(r));
  return all;
}

}  // namespace

void reach_at_random(models::Setup& setup, std::int64_t count) {
  UserSpec& user = *setup.scene.user;
  user.kind = UserKind::reaches;
  if (!user.reaches) user.reaches.emplace();
  user.reaches->count = count;
}

Settings seen(Seen how) {
  if (how == Seen::vision) return {};
  return {"truth.tracker.rate_hz=1000",
          "truth.tracker.latency_ms=1",
          "truth.tracker.noise_mm=[0,0,0]",
          "truth.tracker.marker_noise_mm=0",
          "rig.tracker.measurement_noise_mm=0.01",
          "rig.tracker.usual_age_ms=10",
          "rig.tracker.acceleration_noise_m_s2_per_sqrt_hz=1",
          "truth.tracker.clocks=\"aligned\""};
}

std::vector<ReachRan> run_all(const BenchContext& context, const std::vector<ReachRun>& runs) {
  std::vector<ReachRan> ran(runs.size());
  in_parallel(runs.size(), [&](std::size_t i) { ran[i] = run_one(context, runs[i]); });
  return ran;
}

ReachRun operator+(ReachRun run, const Settings& set) {
  run.set.insert(run.set.end(), set.begin(), set.end());
  return run;
}

ReachRun random_reaches(const std::string& scene, std::int64_t count, std::uint64_t seed) {
  return {scene, {"truth.hand.aborted=0"}, seed, count};
}

ReachRun steady_reaches(double speed, double tilt_deg, int count, std::uint64_t seed) {
  return ReachRun{"wall", quick_presses(count), seed, 0} +
         Settings{fmt::format("user.approach_mm_s=[{}]", 1e3 * speed),
                  fmt::format("user.approach_tilt_deg={}", tilt_deg)};
}

ReachRun slide(double speed, int count, std::uint64_t seed) {
  return ReachRun{"wall", quick_presses(count), seed, 0} +
         Settings{"user.approach_mm_s=[50]", "user.slide_mm=50",
                  fmt::format("user.slide_mm_s={}", 1e3 * speed)};
}

std::vector<ReachOutcome> joined(const std::vector<ReachRan>& ran) {
  std::vector<ReachOutcome> all;
  for (const ReachRan& one : ran) all.insert(all.end(), one.reaches.begin(), one.reaches.end());
  return all;
}

std::vector<double> felts(const std::vector<ReachOutcome>& reaches, double ReachOutcome::*what) {
  std::vector<double> all;
  for (const ReachOutcome& r : reaches)
    if (std::isfinite(r.*what)) all.push_back(r.*what);
  return all;
}

std::vector<double> misses(const std::vector<ReachOutcome>& reaches) {
  return of_each(reaches, [](const ReachOutcome& r) { return r.miss; });
}

std::vector<double> impacts(const std::vector<ReachOutcome>& reaches) {
  return of_each(reaches, [](const ReachOutcome& r) { return r.impact; });
}

double in_time(const std::vector<ReachOutcome>& reaches) {
  const auto there = std::count_if(reaches.begin(), reaches.end(),
                                   [](const ReachOutcome& r) { return r.lead() >= r.travel(); });
  return static_cast<double>(there) / static_cast<double>(reaches.size());
}

Series distribution(const std::string& name, std::vector<double> seconds) {
  const double count = static_cast<double>(seconds.size());
  std::erase_if(seconds, [](double s) { return std::isnan(s); });
  std::sort(seconds.begin(), seconds.end());
  Series series{name, {}, {}};
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    series.x.push_back(1e3 * seconds[i]);
    series.y.push_back(100.0 * static_cast<double>(i + 1) / count);
  }
  return series;
}

}  // namespace enc::bench::reaching
