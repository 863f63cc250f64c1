#include "benchmarks/synchrony/sync_trial.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/base/frames.h"
#include "core/control/stages/step_context.h"
#include "trial/trial.h"

namespace enc::bench::synchrony {
namespace {

using Signal = Eigen::Map<const Eigen::VectorXd>;

// Correlation of the overlapping parts if `later` is shifted `shift` samples earlier. The number of samples
// is equal for all shifts, so that none is favoured.
double correlation(const Signal& earlier, const Signal& later, Eigen::Index most, Eigen::Index shift) {
  const Eigen::Index n = earlier.size() - 2 * most;
  const Eigen::VectorXd a = earlier.segment(most, n).array() - earlier.segment(most, n).mean();
  const Eigen::VectorXd b = later.segment(most + shift, n).array() - later.segment(most + shift, n).mean();
  const double size = a.norm() * b.norm();
  return size > 0.0 ? a.dot(b) / size : kUnset;
}

constexpr double kLongestLag = 0.1;  // s
constexpr double kPeriod = 1e-3;     // s, sample period for the lag of signals

double seconds_of(Time t) { return seconds(t.time_since_epoch()); }

// The machine's own measure: its tip against the buffered first touch.
double haptic_deflection(const trial::Glance& g, const Object& object) {
  if (g.out.mode != Mode::contact || !g.out.first_touch.finite()) return 0.0;
  const Vec<'W'> normal = stages::nearest(object, g.out.first_touch).normal;
  const Point<'W'> tip = g.scene.X_WR * g.in.tip.value.X_RH.origin();
  return dot(g.out.first_touch - tip, normal);
}

double visual_deflection(const Inputs& in) {
  return in.dent.health == Health::ok && in.dent.value.object >= 0 ? in.dent.value.depth : 0.0;
}

class SyncMeasure {
 public:
  void see(const trial::Glance& g) {
    const Object& object = g.scene.objects.front();
    SyncSample s;
    s.t = seconds_of(g.tick.t);
    s.contact = g.out.mode == Mode::contact;
    s.haptic = haptic_deflection(g, object);
    s.visual = visual_deflection(g.in);
    s.truth = std::max(0.0, g.truth.tool_radius - stages::nearest(object, g.truth.tool_tip).distance);
    s.force = g.truth.contact_force.norm();
    s.news = g.in.dent.t != packet_;
    packet_ = g.in.dent.t;
    run.samples.push_back(s);
    run.contacts = g.out.contacts;
    run.held = run.held || g.out.mode == Mode::hold;
    if (g.truth.touching)
      run.given = std::max(
          run.given, g.truth.tool_radius + g.truth.tip_radius - (g.truth.tool_tip - g.truth.tip).norm());
    watch_limit(g, object);
  }
  SyncRun run;

 private:
  void watch_limit(const trial::Glance& g, const Object& object) {
    const auto press = static_cast<std::size_t>(std::max(0, g.out.contacts - 1));
    if (g.out.mode != Mode::contact || press >= run.over.size()) return;
    const double depth = -(stages::nearest(object, g.truth.tip).distance + g.truth.tip_radius);
    const double over = depth - object.limit_at(g.out.contacts);
    run.over[press] = run.over[press] == 0.0 ? over : std::max(run.over[press], over);
  }
  Time packet_{};
};

template <class Counts, class Error>
SyncErrors errors_of(const std::vector<SyncSample>& samples, Counts counts, Error error) {
  double sum = 0.0, size = 0.0, square = 0.0;
  std::int64_t n = 0;
  for (const SyncSample& s : samples) {
    if (!counts(s)) continue;
    const double e = error(s);
    sum += e;
    size += std::abs(e);
    square += e * e;
    ++n;
  }
  if (n == 0) return {kUnset, kUnset, kUnset};
  const auto count = static_cast<double>(n);
  return {size / count, std::sqrt(square / count), sum / count};
}

double to_haptic(const SyncSample& s) { return s.visual - s.haptic; }

double lag_behind(const std::vector<SyncSample>& samples, double SyncSample::*earlier) {
  std::vector<double> a, b;
  a.reserve(samples.size());
  b.reserve(samples.size());
  for (const SyncSample& s : samples) {
    a.push_back(s.*earlier);
    b.push_back(s.visual);
  }
  return lag_of(a, b, kPeriod, kLongestLag);
}

}  // namespace

double lag_of(std::span<const double> earlier, std::span<const double> later, double period, double most) {
  const auto reach = static_cast<Eigen::Index>(std::llround(most / period));
  const auto n = static_cast<Eigen::Index>(std::min(earlier.size(), later.size()));
  if (reach < 1 || n < 4 * reach) return kUnset;
  const Signal a(earlier.data(), n);
  const Signal b(later.data(), n);
  std::vector<double> all;
  all.reserve(static_cast<std::size_t>(2 * reach + 1));
  for (Eigen::Index shift = -reach; shift <= reach; ++shift) all.push_back(correlation(a, b, reach, shift));
  const auto best = std::max_element(all.begin(), all.end());
  if (std::isnan(*best) || best == all.begin() || best + 1 == all.end()) return kUnset;
  const double before = *(best - 1), at = *best, after = *(best + 1);
  const double bend = before - 2.0 * at + after;
  const double between = bend < 0.0 ? 0.5 * (before - after) / bend : 0.0;
  return (static_cast<double>(best - all.begin()) + between - static_cast<double>(reach)) * period;
}

SyncErrors SyncRun::against_haptic(bool at_packets) const {
  return errors_of(
      samples, [&](const SyncSample& s) { return s.contact && (s.news || !at_packets); }, to_haptic);
}

SyncErrors SyncRun::against_truth() const {
  return errors_of(
      samples, [](const SyncSample& s) { return s.contact; },
      [](const SyncSample& s) { return s.visual - s.truth; });
}

SyncErrors SyncRun::with_rests() const {
  const auto in_contact = [](const SyncSample& s) { return s.contact; };
  const auto first = std::find_if(samples.begin(), samples.end(), in_contact);
  const auto last = std::find_if(samples.rbegin(), samples.rend(), in_contact);
  if (first == samples.end()) return {kUnset, kUnset, kUnset};
  return errors_of(
      samples, [&](const SyncSample& s) { return s.t >= first->t && s.t <= last->t; }, to_haptic);
}

double SyncRun::lag() const { return lag_behind(samples, &SyncSample::haptic); }
double SyncRun::truth_lag() const { return lag_behind(samples, &SyncSample::truth); }

double SyncRun::peak_speed() const {
  constexpr std::size_t kOver = 20;  // samples
  double most = 0.0;
  for (std::size_t i = kOver; i < samples.size(); ++i)
    if (samples[i - kOver].contact && samples[i].contact)
      most = std::max(
          most, (samples[i].haptic - samples[i - kOver].haptic) / (samples[i].t - samples[i - kOver].t));
  return most;
}

SyncRun run_sync(const models::Setup& setup, std::uint64_t seed) {
  SyncMeasure measure;
  trial::TrialOptions options;
  options.seed = seed;
  options.watch = [&](const trial::Glance& glance) { measure.see(glance); };
  measure.run.simulated = trial::Trial(setup, options).run().simulated;
  return std::move(measure.run);
}

}  // namespace enc::bench::synchrony
