#include "benchmarks/indentation/indent_run.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "benchmarks/kit/parallel.h"
#include "core/control/stages/walk.h"
#include "sim/truth/random.h"
#include "trial/measure/press_measure.h"

namespace enc::bench::indentation {
namespace {

// Looks at one press: the recorded deflection needs the point that the core has buffered at the first touch.
class Recorder {
 public:
  void see(const trial::Glance& glance) {
    if (glance.out.mode != Mode::contact || glance.out.object < 0) return;
    const Object& object = glance.scene.objects[static_cast<std::size_t>(glance.out.object)];
    const Vec<'W'> normal = stages::nearest(object, glance.out.first_touch).normal;
    const Point<'W'> tip = glance.scene.X_WR * glance.in.tip.value.X_RH.origin();
    const double recorded = dot(glance.out.first_touch - tip, normal);
    const stages::NearestInWorld at_tip = stages::nearest(object, glance.truth.tip);
    const double deflection = -(at_tip.distance + glance.truth.tip_radius);
    const double force = -dot(glance.truth.contact_force, at_tip.normal);
    sensor.add(recorded, -dot(glance.out.felt, normal));
    filtered.add(recorded, -glance.out.force.xyz[2]);
    truth.add(deflection, force);
    greatest = std::max(greatest, deflection);
    if (std::isnan(force_at_limit) && deflection >= object.limit - trial::near_limit(object.limit))
      force_at_limit = force;
    limit = object.limit;
  }
  Branch sensor, filtered, truth;
  double greatest = 0.0, force_at_limit = kUnset, limit = kUnset;
};

}  // namespace

const std::array<Indentation, 3>& indentations() {
  static const std::array<Indentation, 3> kAll{
      {{"A", {}},
       {"B", {"object.ball.behaviour=tennis_ball_B", "user.offset_mm=10"}},
       {"C", {"object.ball.behaviour=tennis_ball_C", "user.polar_deg=10"}}}};
  return kAll;
}

Errors errors_of(const Branch& branch, const Response& reference, bool press) {
  double sum = 0.0, square = 0.0, size = 0.0;
  for (std::size_t i = 0; i < branch.size(); ++i) {
    const double d = branch.deflection[i];
    const double e = branch.force[i] - (press ? reference.press(d) : reference.release(d));
    sum += e;
    size += std::abs(e);
    square += e * e;
  }
  const auto n = static_cast<double>(branch.size());
  if (n == 0.0) return {};
  return {std::sqrt(square / n), size / n, sum / n};
}

Recording split(const Branch& contact, double limit) {
  const std::vector<double>& d = contact.deflection;
  const auto near = [&](double x) { return x >= limit - trial::near_limit(limit); };
  auto end = std::find_if(d.begin(), d.end(), near);
  auto begin = std::find_if(d.rbegin(), d.rend(), near).base();
  if (end == d.end()) end = begin = std::max_element(d.begin(), d.end());
  const auto part = [&](auto from, auto to) {
    Branch branch;
    for (auto i = static_cast<std::size_t>(from - d.begin()); i < static_cast<std::size_t>(to - d.begin());
         ++i)
      if (d[i] > 0.0) branch.add(d[i], contact.force[i]);
    return branch;
  };
  return {part(d.begin(), end), part(begin, d.end())};
}

IndentRun indent_run(const models::Setup& setup, std::uint64_t seed, const trial::TrialOptions& base) {
  Recorder recorder;
  trial::TrialOptions options = base;
  options.seed = seed;
  options.watch = [&](const trial::Glance& glance) { recorder.see(glance); };
  trial::Trial trial(setup, options);
  const trial::TrialResult result = trial.run();
  IndentRun run;
  // The polynomials, whichever law is felt between them.
  run.reference = Response(setup.scene.behaviours.front().curves, 0.0);
  run.limit = trial.scene().objects.front().limit;
  run.sensor = split(recorder.sensor, run.limit);
  run.recorded = split(recorder.filtered, run.limit);
  run.truth = split(recorder.truth, run.limit);
  run.loop = recorder.filtered;
  run.greatest = recorder.greatest;
  run.force_at_limit = recorder.force_at_limit;
  run.simulated = result.simulated;
  run.contacts = result.contacts;
  return run;
}

models::Setup varied(models::Setup setup, std::uint64_t seed, const HandSpread& spread) {
  UserSpec& user = *setup.scene.user;
  sim::Stream hand(seed, "indentation");
  user.press_time *= std::exp(spread.time * hand.normal());
  user.release_time *= std::exp(spread.time * hand.normal());
  user.depth += spread.depth * hand.normal();
  user.offset += spread.offset * hand.normal();
  user.approach_tilt += spread.tilt * std::numbers::pi / 180.0 * hand.normal();
  for (double& speed : user.approach) speed *= std::exp(spread.speed * hand.normal());
  return setup;
}

models::Setup indent_setup(const std::string& models, const Indentation& which, const Words& own,
                           const Words& user) {
  Words set = which.set;
  set.insert(set.end(), own.begin(), own.end());
  set.insert(set.end(), user.begin(), user.end());
  return models::load(models + "/scenes/indentation.toml", "sim", set);
}

models::Setup with_reversal(models::Setup setup, Reversal reversal) {
  for (BehaviourSpec& behaviour : setup.scene.behaviours) behaviour.reversal = reversal;
  return setup;
}

const Words& still_hand() {
  static const Words kStill{"truth.hand.tremor_mm=0", "truth.hand.drift_mm=0"};
  return kStill;
}

std::vector<IndentRun> indent_runs(const models::Setup& setup, std::uint64_t first, std::size_t count) {
  std::vector<IndentRun> runs(count);
  in_parallel(count, [&](std::size_t i) { runs[i] = indent_run(varied(setup, first + i), first + i); });
  return runs;
}

}  // namespace enc::bench::indentation
