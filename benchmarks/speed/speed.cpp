// Speed of the twin: the core's tick, the whole loop against real time, and our stepping wrapper against raw
// mj_step of the same model, paired and interleaved in one run.
#include <algorithm>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/kit.h"
#include "sim/bodies/mujoco.h"
#include "trial/trial.h"

namespace enc::bench::speed {
namespace {

// Our step against raw mj_step, and raw twice more, each from the present state of the physics: every chunk
// does equal work.
Race wrapper_and_raw(sim::Physics& physics, std::size_t rounds) {
  const auto chunk = [&physics, from = physics.save()](auto step) {
    return [&physics, from, step] {
      physics.restore(from);
      for (int i = 0; i < 500; ++i) step(physics);
    };
  };
  const auto raw = chunk([](sim::Physics& p) { mj_step(p.model(), p.data()); });
  return {rounds, {chunk([](sim::Physics& p) { p.step(); }), raw, raw, raw}};
}

void run(Bench& bench) {
  const models::Setup setup = bench.setup();
  trial::TrialOptions options{.seed = bench.context.seed};
  if (bench.context.quick) options.seconds = 20.0;
  Yardstick yardstick;
  options.watch = yardstick.watch();
  trial::Trial trial(setup, options);
  const double start = thread_seconds();
  const trial::TrialResult run = trial.run();
  const double cpu = thread_seconds() - start;
  bench.result.simulated = run.simulated;
  const double tick = cpu / static_cast<double>(run.ticks);
  const double step = bench.context.mutated("whole_tick") ? tick : percentile(run.step_ns, 0.5) * 1e-9;
  bench.cost("step.p50", step * 1e6, "us", "step() of the core, wall clock, one call at a time");
  bench.cost("step.p99_9", percentile(run.step_ns, 0.999) * 1e-3, "us", "the same");
  bench.cost("step_over_yardstick.median", step / yardstick.seconds(), "x", at_most(0.6),
             "step() over a fixed piece of work of the same run (kit/cost.h)");
  bench.cost("times_real_time.cpu", run.simulated / cpu, "x",
             "whole loop on one core, CPU time of its thread");
  bench.cost("loop_over_yardstick.mean",
             (bench.context.mutated("two_ticks") ? 2.0 : 1.0) * tick / yardstick.seconds(), "x", at_most(4.5),
             "a tick of the whole loop, likewise");

  options.watch = {};
  options.seconds = 10.0;  // stops in the middle of a press, tool on tip
  trial::Trial pressing(setup, options);
  pressing.run();
  const Race race = wrapper_and_raw(pressing.world().physics(), bench.context.quick ? 20 : 60);
  bench.cost("wrapper_over_raw.median", race.ratio(0, 1), "x",
             "Physics::step over mj_step, same model and state, chunks of 500 interleaved");
  bench.cost("same_over_same.median", race.ratio(2, 3), "x",
             "raw over raw in the same run: how far the machine can be trusted");
}

const Entry kEntry{"speed", "tennis_ball", "step(), times real time, wrapper over raw mj_step", run};

}  // namespace
}  // namespace enc::bench::speed
