#include "benchmarks/reaching/reach_runs.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "benchmarks/kit/parallel.h"
#include "benchmarks/kit/scenes.h"
#include "benchmarks/kit/statistics.h"
#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/control/stages/step_context.h"

namespace enc::bench::reaching {
namespace {

constexpr double kImpact = 0.050;  // s

double along_surface(const trial::PropTarget& at, const Point<'W'>& tip) {
  const Vec3 apart = (at.point - tip).e();
  const Vec3 n = at.normal.e();
  return (apart - n.dot(apart) * n).norm();
}

ReachResult run_one(const BenchContext& context, const ReachRun& run) {
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

// A person who presses the wall quickly and not deep.
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

std::vector<ReachOutcome> ReachMeasure::reaches() const {
  std::vector<ReachOutcome> all = over_;
  if (begun_) all.push_back(now_);
  return all;
}

void ReachMeasure::begin(const trial::Glance& glance) {
  if (begun_) over_.push_back(now_);
  begun_ = true;
  now_ = ReachOutcome{};
  now_.aim = glance.truth.aim;
  now_.aborted = glance.truth.aborted;
  contacts_before_ = glance.out.contacts;
}

void ReachMeasure::see(const trial::Glance& glance) {
  const double now = seconds(glance.truth.t.time_since_epoch());
  const sim::Phase phase = glance.truth.phase;
  // The core detects the finger's departure late: its counts until the next reach begins belong to this
  // reach.
  if (phase == sim::Phase::approach && phase_ != phase) begin(glance);
  phase_ = phase;
  const bool prepares = far_.see(glance);
  if (!begun_) return;
  watch_force(glance);
  now_.contacts = glance.out.contacts - contacts_before_;
  if (prepares) ++now_.prepares;
  take_picture(glance, now);
  if (std::isnan(now_.met)) {
    if (prepares) {
      now_.prepared = now;
      way_.clear();
    }
    way_.add(glance.truth.tip);
    meet(glance, now);
  } else {
    watch_contact(glance, now);
  }
}

// Pictures stay in W until the place of touch is known.
void ReachMeasure::take_picture(const trial::Glance& glance, double now) {
  const Measurement<TrackedTool>& told = glance.in.tool;
  if (!std::isnan(now_.met) || told.health != Health::ok || told.value.tool < 0 || told.t == newest_) return;
  newest_ = told.t;
  const Point<'T'>& tip = glance.scene.tools[static_cast<std::size_t>(told.value.tool)].tip.centre;
  const Point<'W'> at = glance.scene.X_WC * (told.value.X_CT * tip);
  now_.seen.pictures.push_back({at.e(), seconds(told.t.time_since_epoch()), now});
}

void ReachMeasure::meet(const trial::Glance& glance, double now) {
  const sim::Truth& truth = glance.truth;
  const trial::PropTarget at =
      trial::wanted_at(glance.scene.objects[static_cast<std::size_t>(now_.aim)], truth.tool_tip);
  if (!truth.touching && at.distance > truth.tool_radius) return;
  now_.met = now;
  const Pose<'W', 'N'> X_WN(rotation_z_to(at.normal.e()), at.point + truth.tool_radius * at.normal);
  const Pose<'N', 'W'> X_NW = X_WN.inverse();
  for (SeenReach::Picture& picture : now_.seen.pictures) picture.at = (X_NW * Point<'W'>(picture.at)).e();
  now_.seen.met = now;
  now_.seen.where = (X_NW * truth.tool_tip).e().head<2>();
  now_.chosen = glance.out.object;
  now_.speed = truth.tool_velocity.norm();
  now_.miss = along_surface(at, truth.tip);
  const std::size_t there = way_.there(at.point, kThere);
  if (there > 0 && !std::isnan(now_.prepared))
    now_.arrived = now - glance.scene.dt * static_cast<double>(there - 1);
  watch_contact(glance, now);
}

void ReachMeasure::watch_force(const trial::Glance& glance) {
  const Vec<'W'> force = glance.truth.touching ? glance.truth.contact_force : Vec<'W'>::zero();
  const double change = (force - std::exchange(force_, force)).norm();
  now_.force_step = std::max(now_.force_step, change);
}

void ReachMeasure::watch_contact(const trial::Glance& glance, double now) {
  const sim::Truth& truth = glance.truth;
  if (!truth.touching) return;
  now_.touched = true;
  const trial::PropTarget at =
      trial::wanted_at(glance.scene.objects[static_cast<std::size_t>(now_.aim)], truth.tool_tip);
  if (now_.felt < 0 && glance.out.mode == Mode::contact) {
    now_.felt = glance.out.object;
    now_.felt_after = now - now_.met;
    now_.felt_depth = truth.tool_radius - at.distance;
  }
  if (now - now_.met <= kImpact) now_.impact = std::max(now_.impact, -dot(truth.contact_force, at.normal));
  if (truth.phase == sim::Phase::hold)
    now_.slide_error = std::max(now_.slide_error, along_surface(at, truth.tip));
}

void reach_at_random(models::Setup& setup, std::int64_t count) {
  UserSpec& user = *setup.scene.user;
  user.kind = UserKind::reaches;
  if (!user.reaches) user.reaches.emplace();
  user.reaches->count = count;
}

Settings seen(FingerTracking how) {
  if (how == FingerTracking::vision) return {};
  return {"truth.tracker.rate_hz=1000",
          "truth.tracker.latency_ms=1",
          "truth.tracker.noise_mm=[0,0,0]",
          "truth.tracker.marker_noise_mm=0",
          "rig.tracker.measurement_noise_mm=0.01",
          "rig.tracker.usual_age_ms=10",
          "rig.tracker.acceleration_noise_m_s2_per_sqrt_hz=1",
          "truth.tracker.clocks=\"aligned\""};
}

std::vector<ReachResult> run_all(const BenchContext& context, const std::vector<ReachRun>& runs) {
  std::vector<ReachResult> ran(runs.size());
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

std::vector<ReachOutcome> joined(const std::vector<ReachResult>& ran) {
  std::vector<ReachOutcome> all;
  for (const ReachResult& one : ran) all.insert(all.end(), one.reaches.begin(), one.reaches.end());
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

double contacts_per_reach(const std::vector<ReachOutcome>& reaches) {
  const std::vector<double> all =
      of_each(reaches, [](const ReachOutcome& r) { return static_cast<double>(r.contacts); });
  return std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
}

std::vector<double> force_steps(const std::vector<ReachOutcome>& reaches) {
  return of_each(reaches, [](const ReachOutcome& r) { return r.force_step; });
}

double in_time(const std::vector<ReachOutcome>& reaches) {
  const auto there = std::count_if(reaches.begin(), reaches.end(),
                                   [](const ReachOutcome& r) { return r.lead() >= r.travel(); });
  return static_cast<double>(there) / static_cast<double>(reaches.size());
}

}  // namespace enc::bench::reaching
