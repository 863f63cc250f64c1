// All faults at random, one a second; and hours without any: memory, time, work.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <utility>

#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include "benchmarks/extremes/case.h"
#include "benchmarks/extremes/faults.h"

namespace enc::bench::extremes {
namespace {

// The scene with endless presses on either machine; length in seconds.
models::Setup endless(const BenchContext& context, bool arm, double length) {
  if (arm) return load_scene(context, "keypad", {fmt::format("user.repeats={:.0f}", length / 6.0 + 2.0)});
  return load_scene(context, "session",
                    {fmt::format("user.session.duration_s={:g}", length), "user.session.other_tool=\"\""});
}

// Errors from one second after the last fault on, against those of a run without faults.
struct Nominal {
  double belief = 0.0, tip = 0.0;  // m: of the tool's place; of the machine against its command
  std::int64_t held = 0;
  void see(const trial::Glance& g) {
    if (g.out.view.tip.finite()) belief = std::max(belief, (g.out.view.tip - g.truth.tool_tip).norm());
    held += g.out.mode == Mode::hold ? 1 : 0;
    if (!g.out.manipulator.tip.valid()) return;  // an arm receives a force, not a pose
    const Point<'W'> told = (g.scene.X_WR * g.out.manipulator.tip).origin();
    tip = std::max(tip, (told - g.truth.tip).norm());
  }
};

// A run with faults, and its errors after them.
struct StormResult {
  Run run;
  Nominal after;
};

StormResult stormed(const BenchContext& context, const models::Setup& setup, trial::TrialOptions options,
                    Storm& faults, double after) {
  StormResult found;
  Time now{};
  options.disturb = [&](Inputs& in) {
    faults(now, in);
    if (context.mutated("fault_that_stays") && seconds(now.time_since_epoch()) > after)
      in.tool.value.X_CT.xyz[0] += 0.02;
    now += Duration(1'000'000);
  };
  found.run = judged(context, setup, std::move(options), [&](const trial::Glance& g) {
    if (time_of(g) > after) found.after.see(g);
  });
  return found;
}

CaseResult storm(const BenchContext& context, bool arm, double length) {
  constexpr double kQuiet = 6.0, kRecovers = 1.0;  // s
  const models::Setup setup = endless(context, arm, length + kQuiet);
  CaseResult found{fmt::format("{}.toml, a fault a second for {:g} s", arm ? "keypad" : "session", length),
                   "sound on every tick; error as without faults 1 s after the last",
                   {}};
  Storm faults(context.seed + (arm ? 1 : 0), 1.0, context.mutated("storm_goes_on") ? kInfinite : length);
  const trial::TrialOptions options{.seed = context.seed, .seconds = length + kQuiet, .fit_out = keep_clean};
  Nominal whole;
  const Run undisturbed = judged(context, setup, options, [&](const trial::Glance& g) {
    if (time_of(g) > 2.0) whole.see(g);
  });
  const auto [run, after] = stormed(context, setup, options, faults, length + kRecovers);
  found.numbers = {
      {"faults.value", static_cast<double>(faults.faults()), ""},
      {"belief.ratio", after.belief / whole.belief, "x", at_most(1.2),
       "error of the believed place from 1 s after the last fault on, over the largest without faults"},
      {"held_after.value", static_cast<double>(after.held), "", exactly(0.0), "ticks of hold from then on"},
      {"held.percent",
       100.0 * static_cast<double>(run.judge.held) / static_cast<double>(run.judge.ticks),
       "%",
       {},
       "of all ticks"}};
  if (!arm)
    found.numbers.push_back(
        {"tip.ratio", after.tip / whole.tip, "x", {}, "likewise, of the machine against its command"});
  add_soundness(run, found);
  found.simulated += undisturbed.result.simulated;
  return found;
}

// MiB of the program's memory, without what earlier cases freed.
double resident() {
  malloc_trim(0);
  std::ifstream in("/proc/self/statm");
  double size = 0.0, pages = kUnset;
  in >> size >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1048576.0;
}

// Presses for hours without faults: checks for growth, and that the end is like the beginning.
CaseResult hours(const BenchContext& context, bool arm, double length) {
  CaseResult found{fmt::format("{}.toml for {:g} s", arm ? "keypad" : "session", length),
                   "memory + less than 1 MiB from a tenth on; work as before",
                   {}};
  const models::Setup setup = endless(context, arm, length);
  Judge judge;
  judge.unsound = context.mutated("unsound_tick");
  double before = kUnset, most = 0.0, drift = 0.0;
  std::vector<double> kept;      // mutant: of each tick
  std::array<double, 2> work{};  // J, tool to tip, of each half
  const auto ticks = static_cast<std::int64_t>(1e3 * length);
  trial::TrialOptions options{.seed = context.seed, .seconds = kInfinite};
  const double start = thread_seconds();
  trial::Trial* running = nullptr;
  options.watch = [&](const trial::Glance& g) {
    judge.see(g);
    const bool late = g.tick.index >= ticks / 2;
    const double times = late && context.mutated("late_work_doubled") ? 2.0 : 1.0;
    work[late ? 1 : 0] += times * dot(g.truth.contact_force, g.truth.tip_velocity) * g.scene.dt;
    if (context.mutated("keeps_ticks")) kept.insert(kept.end(), 100, time_of(g));
    const double t = time_of(g);
    drift = std::max(drift, std::abs(running->world().physics().data()->time - t));
    if (g.tick.index == ticks / 10) before = resident();
    if (g.tick.index > ticks / 10 && g.tick.index % 10000 == 0) most = std::max(most, resident());
  };
  options.stop = [&] { return judge.ticks > ticks; };
  trial::Trial trial(setup, options);
  running = &trial;
  Run run;
  run.result = trial.run();
  run.judge = judge;
  found.numbers = {
      {"memory.max", most - before, "MiB", at_most(1.0), "more than after a tenth of the time"},
      {"engine_time.max", drift * 1e9, "ns", {}, "of MuJoCo's own sum of steps; nobody reads it"},
      {"work.ratio", work[1] / work[0], "x", between(0.7, 1.4), "on the tip, second half over first"},
      {"cpu.value", thread_seconds() - start, "s", {}, "CPU time", kUnset, true}};
  add_soundness(run, found);
  return found;
}

}  // namespace

void add_long(Bench& bench, Cases& cases, std::vector<CaseResult>& found) {
  const double length = bench.context.full ? 36000.0 : 60.0;
  for (const bool arm : {true, false}) {
    cases.push_back({arm ? "arm.hours" : "hexapod.hours", {}});
    found.push_back(hours(bench.context, arm, length));
    bench.result.simulated += found.back().simulated;
  }
}

void add_soaks(Cases& cases, const BenchContext& with) {
  const double length = with.full ? 600.0 : 10.0;
  for (const bool arm : {true, false})
    cases.push_back({arm ? "arm.storm" : "hexapod.storm",
                     [=](const BenchContext& context) { return storm(context, arm, length); }});
}

}  // namespace enc::bench::extremes
