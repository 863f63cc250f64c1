// Extreme cases: each runs in a whole trial and must meet its criterion (docs/reference/extremes.md).
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "benchmarks/extremes/case.h"
#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/entry.h"
#include "benchmarks/kit/statistics.h"
#include "core/base/error.h"

namespace enc::bench::extremes {
namespace {

// Error against run time at the edges: extreme cases over time step and integrator, each against its own
// converged run. A failure is a point, too.

constexpr double kRings = 0.05e-3;  // m rms: what goes farther rings

// The quantity that is compared.
enum class ComparedQuantity : std::uint8_t {
  swing,  // rms swing of the tip while the finger holds
  way     // the tool's path from the first touch on
};

struct Study {
  const char* id;
  const char* title;
  const char* scene;
  const char* table;  // TOML table of step and integrator
  ComparedQuantity compared;
  double seconds;  // s
  std::vector<std::string> set;
  double within;                       // %: bound of the default
  bool refused = false;                // the default is refused with this message
  std::vector<std::string> instead{};  // settings of a run that costs as much as the refused one
};

// An arm rings on a wall that is too stiff for it.
Study ringing(const char* id, const char* title, const char* stiffness) {
  return {id,
          title,
          "wall",
          "truth.arm",
          ComparedQuantity::swing,
          4.9,
          {stiffness, "user.push_N=4", "user.approach_mm_s=[100]", "user.press_s=1", "user.hold_s=1.5"},
          25.0};
}

const std::vector<Study>& studies() {
  static const std::vector<Study> kStudies{
      ringing("wall_3", "arm, wall of 3 N/mm: how it rings", "behaviour.phantom_wall.stiffness_N_per_mm=3"),
      ringing("wall_10", "arm, wall of 10 N/mm: how it rings",
              "behaviour.phantom_wall.stiffness_N_per_mm=10"),
      {"impact",
       "arm, touched at 5 m/s: way of the finger",
       "wall",
       "truth.arm",
       ComparedQuantity::way,
       1.5,
       {"user.approach_mm_s=[5000]", "user.approach_from_mm=1500", "user.approach_tilt_deg=0",
        "user.press_s=0.3", "user.hold_s=0.1", "user.release_s=0.3", "user.rest_s=0.2"},
       10.0},
      {"light",
       "hexapod, tool of 1 g: its way",
       "tennis_ball",
       "truth.world",
       ComparedQuantity::way,
       1.5,
       {"tool.stylus.mass_kg=0.001", "user.approach_mm_s=[200]", "user.press_s=0.3", "user.release_s=0.3",
        "user.approach_from_mm=50"},
       kUnset,
       true,
       {"tool.stylus.mass_kg=0.05"}},
  };
  return kStudies;
}

struct StepSetting {
  std::string integrator;
  double step;  // s
};

struct Outcome {
  std::vector<Vec3> way{};    // m, of the tool, at each tick
  double swing = 0.0;         // m rms
  std::int64_t touched = -1;  // tick
  double cpu = kUnset;        // s of CPU for each second of experiment
  std::string failure{};
};

double rms_about_mean(std::vector<double> all) {
  if (all.empty()) return 0.0;
  const double middle = mean(all);
  for (double& x : all) x -= middle;
  return rms(all);
}

Outcome run_once(const Study& study, const BenchContext& context, const StepSetting& at,
                 const std::vector<std::string>& more = {}) {
  Outcome found;
  // A hand without drift, so that each run touches at the same place.
  std::vector<std::string> held{"truth.hand.drift_mm=0",
                                fmt::format("{}.timestep_us={:g}", study.table, at.step * 1e6),
                                fmt::format("{}.integrator={}", study.table, at.integrator)};
  held.insert(held.end(), more.begin(), more.end());
  std::vector<double> held_at;  // m, of the tip along z, while the finger holds
  try {
    const models::Setup setup = load_scene(context, study.scene, study.set, held);
    trial::TrialOptions options{.seed = context.seed, .seconds = study.seconds};
    const double start = thread_seconds();
    const Run run = judged(context, setup, options, [&](const trial::Glance& g) {
      found.way.push_back(g.truth.tool_tip.e());
      if (g.truth.touching && found.touched < 0) found.touched = g.tick.index;
      if (g.truth.phase == sim::Phase::hold) held_at.push_back(g.truth.tip.xyz[2]);
    });
    found.swing = rms_about_mean(held_at);
    found.cpu = (thread_seconds() - start) / run.result.simulated;
    if (run.result.diverged_at >= 0)
      found.failure = fmt::format("diverged at tick {}", run.result.diverged_at);
    else if (run.judge.broken() > 0)
      found.failure = run.judge.first();
    else if (found.touched < 0)
      found.failure = "never touched";
  } catch (const Error& e) {
    found.failure = e.what();
  }
  return found;
}

// % of the converged run's; NaN with the reason if the run failed, or if just one of the two rings.
double error_of(const Study& study, const Outcome& converged, Outcome& found) {
  if (!found.failure.empty()) return kUnset;
  if (study.compared == ComparedQuantity::swing) {
    if ((found.swing > kRings) != (converged.swing > kRings)) {
      found.failure = found.swing > kRings ? "rings, where it does not" : "is still, where it rings";
      return kUnset;
    }
    return 100.0 * std::abs(found.swing / converged.swing - 1.0);
  }
  const auto from = static_cast<std::size_t>(converged.touched);
  const std::size_t to = std::min(found.way.size(), converged.way.size());
  double sum = 0.0, size = 0.0;
  for (std::size_t i = from; i < to; ++i) {
    sum += (found.way[i] - converged.way[i]).squaredNorm();
    size += (converged.way[i] - converged.way[from]).squaredNorm();
  }
  return 100.0 * std::sqrt(sum / size);
}

struct StudyTrial {
  const Study* study;
  StepSetting at;
  double error = kUnset, cost = kUnset;  // %; s of CPU for each second
  std::string failure{};
};

bool is_default(const StudyTrial& point, const BenchContext& context) {
  const models::Setup setup = load_scene(context, point.study->scene);
  const sim::Stepping shipped = setup.twin.stepping(setup.scene);
  return shipped.integrator == point.at.integrator && std::abs(shipped.timestep - point.at.step) < 1e-9;
}

// Rounds go through all points, so that a slow moment of the machine does not hit one alone.
void race(const BenchContext& context, int rounds, const std::map<const Study*, Outcome>& converged,
          std::vector<StudyTrial>& points) {
  std::vector<std::vector<double>> costs(points.size());
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < points.size(); ++i) {
      StudyTrial& point = points[i];
      Outcome found = run_once(*point.study, context, point.at);
      point.error = error_of(*point.study, converged.at(point.study), found);
      point.failure = found.failure;
      if (std::isnan(found.cpu)) found = run_once(*point.study, context, point.at, point.study->instead);
      costs[i].push_back(found.cpu);
    }
  for (std::size_t i = 0; i < points.size(); ++i) points[i].cost = median(costs[i]);
}

void draw(Bench& bench, const std::vector<std::string>& integrators, const std::vector<StudyTrial>& points) {
  Plot plot{.id = "work_precision",
            .title = "Error against run time at the edges",
            .x_label = "CPU time for one second of experiment (s)",
            .y_label = "error (% of the converged run)",
            .log_x = true,
            .log_y = true,
            .caption =
                "Time steps from 1 ms (left) on, halved each time. Crosses at the upper edge failed: what "
                "they say is another thing than the converged run, or they were refused before they ran; "
                "then they stand where a heavier tool does. The shipped step and integrator are marked; "
                "where they failed, by a black cross."};
  plot.columns = 2;
  std::map<const Study*, std::size_t> panel;
  for (const Study& study : studies()) {
    panel[&study] = plot.panels.size();
    plot.panels.emplace_back(study.title);
  }
  // Draw failures after their curves, so that they take their curves' colour.
  const auto draw_all = [&](std::size_t in, const std::string& name, bool paper, const auto& wanted) {
    Series there{.name = name, .mark = paper ? Mark::points : Mark::both, .paper = paper, .panel = in};
    Series failed{.name = name + ", failed", .mark = Mark::crosses, .panel = in};
    for (const StudyTrial& point : points)
      if (panel.at(point.study) == in && wanted(point))
        (point.failure.empty() ? there : failed).add(point.cost, point.error);
    plot.series.push_back(std::move(there));
    plot.series.push_back(std::move(failed));
  };
  for (std::size_t in = 0; in < plot.panels.size(); ++in) {
    for (const std::string& integrator : integrators)
      draw_all(in, integrator, false,
               [&](const StudyTrial& point) { return point.at.integrator == integrator; });
    draw_all(in, "as shipped", true,
             [&](const StudyTrial& point) { return is_default(point, bench.context); });
  }
  bench.plot(std::move(plot));
}

bool holds(const Number& n) {
  Figure figure;
  figure.twin = n.value;
  figure.low = n.bounds.low;
  figure.high = n.bounds.high;
  return figure.ok();
}

// The numbers that have bounds, except those bounded by zero.
std::string measured(const CaseResult& found) {
  std::string text;
  for (const Number& n : found.numbers) {
    const bool none = n.bounds.low == 0.0 && n.bounds.high == 0.0;
    if (none || (std::isnan(n.bounds.low) && std::isnan(n.bounds.high))) continue;
    const std::string what = n.what.substr(0, n.what.find_last_of('.'));
    text += fmt::format("{}{} {:.3g}{}{}", text.empty() ? ": " : ", ", what, n.value,
                        *n.unit == '\0' ? "" : " ", n.unit);
  }
  return text;
}

// "holds", or each number that misses its bounds; STATED for a criterion that cannot be met.
std::string verdict_of(const CaseResult& found) {
  std::string missed, stated;
  const auto add = [](std::string& text, const std::string& more) {
    text += (text.empty() ? "" : ", ") + more;
  };
  for (const Number& n : found.numbers) {
    if (!holds(n)) add(missed, fmt::format("{} {:.4g} {}", n.what, n.value, n.unit));
    if (!(n.value > n.wanted)) continue;
    const std::string times = n.wanted > 0.0 ? fmt::format(" ({:.3g} times)", n.value / n.wanted) : "";
    add(stated, fmt::format("{} {:.3g} {} instead of {:g}{}", n.what, n.value, n.unit, n.wanted, times));
  }
  const std::string verdict = !missed.empty()   ? "MISSED: " + missed
                              : !stated.empty() ? "STATED: " + stated
                                                : "holds" + measured(found);
  return found.words.empty() ? verdict : verdict + "; " + found.words;
}

// Each study's converged run.
std::map<const Study*, Outcome> converged_runs(Bench& bench, const StepSetting& fine) {
  std::vector<const Study*> each;
  for (const Study& study : studies()) each.push_back(&study);
  const std::vector<Outcome> references =
      bench.each(each, [&](const Study* study) { return run_once(*study, bench.context, fine); });
  std::map<const Study*, Outcome> converged;
  for (std::size_t i = 0; i < each.size(); ++i) converged[each[i]] = references[i];
  return converged;
}

// The figures of a point that is the default.
void judge_default(Bench& bench, const StudyTrial& p) {
  const std::string id = fmt::format("work_precision.{}.", p.study->id);
  const std::string note = fmt::format("default: {} at {:g} us", p.at.integrator, p.at.step * 1e6);
  bench.figure(id + "failed.value", p.failure.empty() ? 0.0 : 1.0, "", exactly(p.study->refused ? 1.0 : 0.0),
               p.failure.empty() ? note : note + ": " + p.failure);
  if (!p.study->refused) bench.figure(id + "error.value", p.error, "%", at_most(p.study->within), note);
}

// Error against run time.
void add_error_over_time(Bench& bench) {
  const std::vector<std::string> integrators{"rk4", "implicitfast", "euler", "discrete"};
  constexpr int kHalved = 5;
  std::vector<StudyTrial> points;
  for (const Study& study : studies())
    for (const std::string& integrator : integrators)
      for (int i = 0; i < kHalved; ++i) points.push_back({&study, {integrator, std::ldexp(1e-3, -i)}});
  const std::map<const Study*, Outcome> converged = converged_runs(bench, {"rk4", std::ldexp(1e-3, -6)});
  race(bench.context, 3, converged, points);

  Table table{"work_precision",
              "Error against run time at the edges",
              {"case", "integrator", "time step (us)", "error (%)", "CPU s per s", "failure"}};
  for (const StudyTrial& p : points) {
    table.add(p.study->id, p.at.integrator, fmt::format("{:g}", p.at.step * 1e6),
              p.failure.empty() ? fmt::format("{:.3g}", p.error) : "", fmt::format("{:.3g}", p.cost),
              p.failure);
    if (is_default(p, bench.context)) judge_default(bench, p);
  }
  for (const Study& study : studies())
    bench.figure(fmt::format("work_precision.{}.converged.value", study.id),
                 converged.at(&study).failure.empty() ? 1.0 : 0.0, "", exactly(1.0),
                 converged.at(&study).failure);
  bench.table(std::move(table));
  draw(bench, integrators, points);
}

void run(Bench& bench) {
  Cases cases;
  add_walls(cases);
  add_touches(cases);
  add_inputs(cases, bench.context.full);
  add_links(cases);
  add_places(cases);
  add_refusals(cases);
  add_soaks(cases, bench.context);
  std::vector<CaseResult> all = bench.each(cases, [&](const Case& one) { return one.run(bench.context); });
  add_long(bench, cases, all);
  Table table{"cases", "Extreme cases", {"case", "what is done", "criterion", "verdict"}};
  double missed = 0.0, stated = 0.0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (const Number& n : all[i].numbers) {
      bench.figure(cases[i].id + "." + n.what, n.value, n.unit, n.bounds, n.note);
      bench.result.figures.back().cost = n.cost;
    }
    const std::string verdict = verdict_of(all[i]);
    missed += verdict.starts_with("MISSED") ? 1.0 : 0.0;
    stated += verdict.starts_with("STATED") ? 1.0 : 0.0;
    table.add(cases[i].id, all[i].did, all[i].criterion, verdict);
  }
  bench.figure("all.missed.value", missed, "", exactly(0.0), "cases that miss their criterion");
  bench.figure("all.stated.value", stated, "", "cases that miss it and say by how much and why");
  bench.figure("all.cases.value", static_cast<double>(cases.size()), "", "cases");
  table.printed = true;
  bench.table(std::move(table));
  add_wall_plot(bench, cases, all);
  if (bench.context.full) add_error_over_time(bench);
}

const Reads kReads{"extremes", {.scenes = {"*"}}};
const Entry kEntry{"extremes", "wall", "what should not happen: extreme cases, each with its criterion", run};

}  // namespace

Run judged(const BenchContext& context, const models::Setup& setup, trial::TrialOptions options,
           const std::function<void(const trial::Glance&)>& also) {
  Run run;
  run.judge.unsound = context.mutated("unsound_tick");
  options.watch = [&](const trial::Glance& glance) {
    run.judge.see(glance);
    if (also) also(glance);
  };
  run.result = trial::Trial(setup, std::move(options)).run();
  return run;
}

void add_soundness(const Run& run, CaseResult& found) {
  std::string why = "ticks that the judge objects to, and warnings of the engine";
  if (!run.judge.first().empty()) why = run.judge.first();
  if (!run.result.divergence.empty()) why = run.result.divergence;
  const double warned = run.result.diverged_at < 0 ? 0.0 : 1.0;
  found.numbers.push_back(
      {"broken.value", static_cast<double>(run.judge.broken()) + warned, "", exactly(0.0), why});
  found.simulated += run.result.simulated;
}

}  // namespace enc::bench::extremes
