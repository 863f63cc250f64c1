// How fast is the twin? The core's tick, the whole loop against real time, and our stepping wrapper against
// raw mj_step of the same model, paired and interleaved in one run.
#include <algorithm>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "benchmarks/kit/load_scene.h"
#include "benchmarks/kit/statistics.h"
#include "benchmarks/kit/yardstick.h"
#include "sim/bodies/mujoco.h"
#include "trial/trial.h"

namespace enc::bench::speed {
namespace {

// CPU seconds of `steps` physics steps from a saved state, so that every chunk does the same work.
template <class Step>
double chunk(sim::Physics& physics, const std::vector<double>& from, int steps, const Step& step) {
  physics.restore(from);
  const double start = thread_seconds();
  for (int i = 0; i < steps; ++i) step(physics);
  return thread_seconds() - start;
}

struct Ratios {
  double wrapper, same;
};
Ratios interleaved(sim::Physics& physics, int rounds) {
  const std::vector<double> from = physics.save();
  const auto ours = [](sim::Physics& p) { p.step(); };
  const auto raw = [](sim::Physics& p) { mj_step(p.model(), p.data()); };
  std::vector<double> wrapper;
  std::vector<double> same;
  constexpr int kSteps = 500;
  for (int i = 0; i < rounds; ++i) {
    const bool first = i % 2 == 0;  // who goes first alternates
    const double a = first ? chunk(physics, from, kSteps, ours) : chunk(physics, from, kSteps, raw);
    const double b = first ? chunk(physics, from, kSteps, raw) : chunk(physics, from, kSteps, ours);
    const double c = chunk(physics, from, kSteps, raw);
    const double d = chunk(physics, from, kSteps, raw);
    if (i == 0) continue;  // warm-up
    wrapper.push_back(first ? a / b : b / a);
    same.push_back(c / d);
  }
  return {median(wrapper), median(same)};
}

}  // namespace

BenchResult run(const BenchContext& context) {
  BenchResult result{"speed", "tennis_ball", 0, 0, {}};
  const models::Setup setup = load_scene(context, "tennis_ball");
  trial::TrialOptions options;
  options.seed = context.seed;
  if (context.quick) options.seconds = 20.0;
  Yardstick yardstick;
  options.watch = [&](const trial::Glance& glance) {
    if (glance.tick.index % 100 == 0) yardstick.measure();
  };
  trial::Trial trial(setup, options);
  const double start = thread_seconds();
  const trial::TrialResult run = trial.run();
  const double cpu = thread_seconds() - start;
  result.simulated = run.simulated;

  options.watch = {};
  options.seconds = 10.0;  // stops in the middle of a press, tool on tip
  trial::Trial pressing(setup, options);
  pressing.run();
  const Ratios ratios = interleaved(pressing.world().physics(), context.quick ? 21 : 61);
  const auto add = [&](const char* id, double twin, const char* unit, double low, double high,
                       const char* note) {
    result.figures.push_back({id, kUnset, twin, unit, Role::ours, low, high, note});
  };
  add("speed.step.p50", percentile(run.step_ns, 0.5) * 1e-3, "us", kUnset, kUnset,
      "step() of the core, wall clock, one call at a time");
  add("speed.step.p99_9", percentile(run.step_ns, 0.999) * 1e-3, "us", kUnset, kUnset, "the same");
  add("speed.step_over_yardstick.median", percentile(run.step_ns, 0.5) * 1e-9 / yardstick.seconds(), "x",
      kUnset, 0.6, "step() over a fixed piece of work of the same run (kit/yardstick.h)");
  add("speed.times_real_time.cpu", run.simulated / cpu, "x", kUnset, kUnset,
      "whole loop on one core, CPU time of its thread");
  add("speed.loop_over_yardstick.mean", cpu / static_cast<double>(run.ticks) / yardstick.seconds(), "x",
      kUnset, 4.5, "a tick of the whole loop, likewise");
  // The machine is no better than with itself; where that is 10 % and more, it cannot tell.
  const double noise = std::min(1.1, std::max(ratios.same, 1.0 / ratios.same));
  add("speed.wrapper_over_raw.median", ratios.wrapper, "x", 0.90 / noise, 1.05 * noise,
      "Physics::step over mj_step, same model and state, chunks of 500 interleaved; bounds as far apart as "
      "the "
      "machine is from itself");
  add("speed.same_over_same.median", ratios.same, "x", kUnset, kUnset,
      "raw over raw in the same run: how far the machine can be trusted");
  return result;
}

}  // namespace enc::bench::speed
