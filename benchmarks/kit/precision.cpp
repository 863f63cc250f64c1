#include "benchmarks/kit/precision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/scenes.h"
#include "benchmarks/kit/statistics.h"
#include "core/base/error.h"
#include "trial/trial.h"

namespace enc::bench {
namespace {

// The observed orders: no bounds, as a contact is not smooth.
std::string orders_text(const trial::Precision& all) {
  std::string text;
  std::vector<double> steps, errors;
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    steps.push_back(all.points[i].step);
    errors.push_back(all.points[i].error);
    if (i + 1 < all.points.size() && all.points[i + 1].integrator == all.points[i].integrator) continue;
    const double order = fitted_order(steps, errors, all.second.error);
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", all.points[i].integrator,
                        std::isnan(order) ? std::string("none, at the floor") : fmt::format("{:.1f}", order));
    steps.clear();
    errors.clear();
  }
  return text;
}

struct Form {
  const char* name;   // of truth.hexapod.form
  const char* table;  // TOML table of its step and integrator
  double reference;   // step of the converged run, s
  std::vector<double> steps;
};
const std::array<Form, 2>& forms() {
  static const std::array<Form, 2> kForms{
      Form{"control", "truth.world", 20e-6, {1e-3, 0.5e-3, 0.25e-3, 0.125e-3, 0.0625e-3}},
      Form{"structural", "truth.structure", 31.25e-6, {1e-3, 0.5e-3, 0.25e-3, 0.125e-3, 0.0625e-3}}};
  return kForms;
}
// The default form of a scene, without any setting.
bool is_shipped(const Form& form) { return std::string_view(form.name) == "control"; }
constexpr std::array<std::string_view, 4> kIntegrators{"implicitfast", "euler", "rk4", "discrete"};

// The sweep: all of it with --full, else a part that takes some seconds.
struct Extent {
  std::vector<Form> forms;
  std::vector<std::string_view> integrators{kIntegrators.begin(), kIntegrators.end()};
  double seconds = kUnset;
  int rounds = 3;
};
Extent extent_of(const WorkSpec& spec, const BenchContext& context) {
  Extent all{{forms().begin(), forms().end()}};
  all.seconds = spec.seconds;
  if (context.full) return all;
  constexpr double kShort = 6.0;  // s
  all.forms = {{forms()[0].name, forms()[0].table, 50e-6, {1e-3, 0.25e-3}}};
  all.integrators = {"implicitfast", "rk4"};
  all.seconds = std::isnan(spec.seconds) ? kShort : std::min(spec.seconds, kShort);
  all.rounds = 1;
  return all;
}

struct Path {
  std::vector<Vec3> tip;  // true tip position at each tick
  double cpu = kUnset;    // s of CPU for each second of experiment
  double yards = kUnset;  // yardsticks for each tick
  std::string failure;    // why the run failed
};

Path run_once(const WorkSpec& spec, const BenchContext& context, const Extent& extent, const Form& form,
              std::string_view integrator, double step) {
  Path path;
  const std::vector<std::string> compared{fmt::format("truth.hexapod.form={}", form.name),
                                          fmt::format("{}.timestep_us={:g}", form.table, step * 1e6),
                                          fmt::format("{}.integrator={}", form.table, integrator)};
  try {
    trial::TrialOptions options{.seed = context.seed, .seconds = extent.seconds};
    options.watch = [&](const trial::Glance& glance) { path.tip.push_back(glance.truth.tip.e()); };
    trial::Trial trial(load_scene(context, spec.scene, spec.set, compared), options);
    const double before = yardstick_now(), start = thread_seconds();
    const trial::TrialResult run = trial.run();
    const double cpu = thread_seconds() - start;
    path.cpu = cpu / run.simulated;
    path.yards = cpu / static_cast<double>(run.ticks) / (0.5 * (before + yardstick_now()));
    if (run.diverged_at >= 0)
      path.failure = fmt::format("diverged at tick {}", run.diverged_at);
    else if (!path.tip.back().allFinite())
      path.failure = "not finite";
  } catch (const Error& e) {
    path.failure = e.what();
  }
  return path;
}

double rms(const Path& a, const Path& b) {
  if (a.tip.size() != b.tip.size() || a.tip.empty()) return kUnset;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.tip.size(); ++i) sum += (a.tip[i] - b.tip[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.tip.size()));
}

struct Point {
  const Form* form;
  std::string_view integrator;
  double step;
  double error = kUnset, cpu = kUnset;  // m; s for each second
  double yards = kUnset;                // yardsticks for each tick
  double spread = kUnset;               // the largest over the least of its runs
  std::string failure{};
  [[nodiscard]] bool good(double accuracy) const { return failure.empty() && error <= accuracy; }
};

struct StudyData {
  std::vector<Point> points;
  std::map<const Form*, double> floor;  // m rms between two converged runs, of elastic legs
};

// Three runs, interleaved with those of all other points, so that a slow moment of the machine does not hit
// one point alone.
StudyData measured(const WorkSpec& spec, const BenchContext& context, const Extent& extent) {
  StudyData all;
  std::vector<Point>& points = all.points;
  std::map<const Form*, Path> converged;
  for (const Form& form : extent.forms) {
    const Path& truth = converged[&form] = run_once(spec, context, extent, form, "rk4", form.reference);
    if (!truth.failure.empty()) throw Error("the converged run failed: " + truth.failure);
    if (context.full && !is_shipped(form)) {
      const Path other = run_once(spec, context, extent, form, "implicitfast", 0.5 * form.reference);
      if (!other.failure.empty()) throw Error("the second converged run failed: " + other.failure);
      all.floor[&form] = rms(other, truth);
    }
    for (const std::string_view integrator : extent.integrators)
      for (const double step : form.steps) points.push_back({&form, integrator, step});
  }
  std::vector<std::vector<double>> cpu(points.size()), yards(points.size());
  for (int round = 0; round < extent.rounds; ++round)
    for (std::size_t i = 0; i < points.size(); ++i) {
      Point& point = points[i];
      if (!point.failure.empty()) continue;
      const Path path = run_once(spec, context, extent, *point.form, point.integrator, point.step);
      point.failure = path.failure;
      point.error = rms(path, converged[point.form]);
      cpu[i].push_back(path.cpu);
      yards[i].push_back(path.yards);
      if (context.progress)
        context.progress(static_cast<double>(i + points.size() * static_cast<std::size_t>(round)) /
                         static_cast<double>(static_cast<std::size_t>(extent.rounds) * points.size()));
    }
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].cpu = median(cpu[i]);
    points[i].yards = median(yards[i]);
    const auto [least, most] = std::minmax_element(yards[i].begin(), yards[i].end());
    points[i].spread = *most / *least;
  }
  return all;
}

// The rig's own setting, from its own files.
bool is_default(const Point& point, const models::Setup& setup) {
  const bool control = is_shipped(*point.form);
  const double step = control ? setup.twin.world.timestep : setup.twin.structure.timestep;
  const std::string& integrator = control ? setup.twin.world.integrator : setup.twin.structure.integrator;
  return std::abs(point.step - step) < 1e-9 && integrator == point.integrator;
}

void add_figures(const WorkSpec& spec, const Extent& extent, bool full, const StudyData& all,
                 const models::Setup& setup, BenchResult& result) {
  const std::vector<Point>& points = all.points;
  for (const Form& form : extent.forms) {
    const Point* chosen = nullptr;
    const Point* cheapest = nullptr;
    for (const Point& point : points) {
      if (point.form != &form) continue;
      if (is_default(point, setup)) chosen = &point;
      if (point.good(spec.accuracy) && (cheapest == nullptr || point.yards < cheapest->yards))
        cheapest = &point;
    }
    if (chosen == nullptr) continue;  // --set has replaced its step
    const std::string id = fmt::format("{}.work_precision.{}.", spec.benchmark, form.name);
    const auto floor = all.floor.find(&form);
    const bool bounded = is_shipped(form) || spec.elastic_bounded;
    const double most = bounded ? spec.accuracy + (floor == all.floor.end() ? 0.0 : floor->second) : kUnset;
    result.figures.push_back(
        {id + "error.rms", kUnset, chosen->error * 1e6, "um", Role::ours, kUnset, most * 1e6,
         fmt::format("true tip's path at the default, {} at {:g} us, from the converged one",
                     chosen->integrator, chosen->step * 1e6)});
    if (!full) continue;
    if (floor != all.floor.end())
      result.figures.push_back({id + "floor.rms", kUnset, floor->second * 1e6, "um", Role::ours, kUnset,
                                kUnset, "what two converged runs differ by; others may differ by more"});
    if (!bounded) continue;
    result.figures.push_back(
        {id + "default_over_cheapest.cpu", kUnset,
         cheapest != nullptr ? chosen->yards / cheapest->yards : kUnset, "x", Role::ours, kUnset, kUnset,
         cheapest != nullptr ? fmt::format("cheapest that meets {:g} um: {} at {:g} us", spec.accuracy * 1e6,
                                           cheapest->integrator, cheapest->step * 1e6)
                             : "no point meets the accuracy"});
    result.figures.back().cost = true;
    result.figures.push_back({id + "spread.max", kUnset, chosen->spread, "x", Role::ours, kUnset, kUnset,
                              "yardsticks of the default, the greatest over the least of three runs"});
    result.figures.back().cost = true;
  }
}

// The points of a study, the compared quantity and the accuracy that the shipped setting shall hold.
struct StudyComparison {
  const trial::Precision& all;
  const PrecisionNorm& norm;
  double accuracy;  // in the study's unit
  [[nodiscard]] bool of_force() const { return !norm.quantities; }
  [[nodiscard]] std::string told(double error) const {
    return fmt::format("{:.4f} {}", error * norm.scale, norm.unit);
  }
};

Table precision_table(const StudyComparison& compared) {
  const PrecisionNorm& norm = compared.norm;
  Table table{"precision",
              fmt::format("Error of {} against run time", norm.of),
              {"integrator", "timestep_us", compared.of_force() ? "force_N" : "error_percent", "path_um",
               "yardsticks a tick", "times_real_time", "ships", "failure"}};
  for (const trial::PrecisionPoint& point : compared.all.points) {
    const bool there = point.failure.empty();
    table.add(point.integrator, fmt::format("{:g}", point.step * 1e6),
              there ? fmt::format("{:.4f}", point.error * norm.scale) : "",
              there ? fmt::format("{:.2f}", point.way * 1e6) : "", fmt::format("{:.2f}", point.yards),
              fmt::format("{:.0f}", 1.0 / point.cpu), point.shipped ? "ships" : "", point.failure);
  }
  table.note = "orders found: " + orders_text(compared.all);
  return table;
}

Plot precision_plot(const StudyComparison& compared, const std::string& scene) {
  const trial::Precision& all = compared.all;
  const PrecisionNorm& norm = compared.norm;
  std::vector<trial::PrecisionPoint> scaled = all.points;
  for (trial::PrecisionPoint& point : scaled) point.error *= norm.scale;
  return force_plot(
      {.id = "precision",
       .title = fmt::format("Error of {} against run time: {}", norm.of, scene),
       .x_label = "CPU time of a tick over a fixed piece of work",
       .y_label = fmt::format("error of {} ({})", norm.of, norm.unit == "N" ? "N rms" : norm.unit),
       .caption =
           fmt::format("{}, against a converged run of the same hand ({:g} s of it). Two converged runs "
                       "differ by {}; {} is what this shall hold. What failed stands at the upper edge.",
                       compared.of_force() ? "True force while something touches"
                                           : "The greatest difference, over the greatest value",
                       all.seconds, compared.told(all.second.error), compared.told(compared.accuracy))},
      scaled, &trial::PrecisionPoint::yards,
      {{"allowed", compared.accuracy * norm.scale}, {"floor", all.second.error * norm.scale}});
}

// A curve for each form and integrator; adds each point to the table.
std::vector<CostCurve> work_curves(const Extent& extent, const std::vector<Point>& points, Table& table) {
  std::vector<CostCurve> curves;
  for (const Form& form : extent.forms)
    for (const std::string_view integrator : extent.integrators) {
      CostCurve curve{fmt::format("{} {}", form.name, integrator)};
      for (const Point& point : points) {
        if (point.form != &form || point.integrator != integrator) continue;
        const bool there = point.failure.empty();
        curve.cost.push_back(point.yards);
        curve.error.push_back(there ? point.error * 1e6 : kUnset);
        table.add(form.name, integrator, fmt::format("{:g}", point.step * 1e6),
                  there ? fmt::format("{:.3g}", point.error * 1e6) : "", fmt::format("{:.2f}", point.yards),
                  fmt::format("{:.3g}", point.cpu), fmt::format("{:.0f}", 1.0 / point.cpu), point.failure);
      }
      curves.push_back(std::move(curve));
    }
  return curves;
}

}  // namespace

double accuracy_of(const trial::Precision& all, double wanted) {
  return std::max(wanted, 2.0 * all.second.error);
}

ForceStudy force_study(const BenchContext& context, const std::string& scene,
                       const std::vector<std::string>& set, const trial::PrecisionOptions& options) {
  trial::PrecisionOptions asked = options;
  asked.seed = context.seed;
  asked.cpu = thread_seconds;
  asked.drivers = modules_of(context);
  asked.yardstick = yardstick_now;
  ForceStudy study{scene};
  study.all = trial::precision_of(
      [&](const std::vector<std::string>& held) { return load_scene(context, scene, set, held); }, asked);
  study.simulated =
      study.all.seconds * static_cast<double>(asked.rounds) * static_cast<double>(study.all.points.size());
  return study;
}

Plot force_plot(Plot plot, const std::vector<trial::PrecisionPoint>& points,
                double trial::PrecisionPoint::*cost, const std::vector<ErrorLevel>& levels) {
  std::vector<CostCurve> curves;
  CostCurve ships{"as it ships"};
  for (const trial::PrecisionPoint& point : points) {
    auto at = std::find_if(curves.begin(), curves.end(),
                           [&](const CostCurve& curve) { return curve.name == point.integrator; });
    if (at == curves.end()) at = curves.insert(at, {point.integrator});
    const double error = point.failure.empty() ? point.error : kUnset;
    at->cost.push_back(point.*cost);
    at->error.push_back(error);
    if (!point.shipped) continue;
    ships.cost.push_back(point.*cost);
    ships.error.push_back(error);
  }
  if (!ships.cost.empty()) curves.push_back(std::move(ships));
  return cost_beside_error(std::move(plot), curves, levels);
}

void add_force_precision(Bench& bench, const std::vector<std::string>& set, const PrecisionNorm& norm) {
  if (bench.context.quick) return;
  trial::PrecisionOptions options;
  options.quantities = norm.quantities;
  if (!bench.context.full) {
    options.rounds = 1;
    options.seconds = 4.0;
    options.converged = 20;
    options.grid = {{"implicitfast", "rk4"}, {1, 4}};
  }
  const ForceStudy study = force_study(bench.context, bench.result.scene, set, options);
  bench.result.simulated += study.simulated;
  const trial::Precision& all = study.all;
  const StudyComparison compared{all, norm, accuracy_of(all, norm.accuracy)};
  bench.table(precision_table(compared));
  bench.plot(precision_plot(compared, study.scene));
  const trial::PrecisionPoint* shipped = trial::shipped(all.points);
  if (shipped == nullptr) return;
  bench.figure(compared.of_force() ? "precision.error.rms" : "precision.error.max",
               shipped->error * norm.scale, norm.unit.c_str(), at_most(compared.accuracy * norm.scale),
               fmt::format("{} at what ships, {} at {:g} us; two converged runs differ by {}", norm.of,
                           shipped->integrator, shipped->step * 1e6, compared.told(all.second.error)));
  if (!bench.context.full) return;
  const trial::PrecisionPoint* best = cheapest(all.points, {compared.accuracy});
  bench.cost(
      "precision.default_over_cheapest.cpu", best != nullptr ? shipped->yards / best->yards : kUnset, "x",
      best != nullptr ? fmt::format("cheapest that holds: {} at {:g} us", best->integrator, best->step * 1e6)
                      : "nothing holds it");
  bench.cost("precision.spread.max", shipped->spread, "x",
             "yardsticks of what ships, the greatest over the least of three runs");
}

void add_work_precision(const WorkSpec& spec, const BenchContext& context, BenchResult& result) {
  const Extent extent = extent_of(spec, context);
  const StudyData all = measured(spec, context, extent);
  const std::vector<Point>& points = all.points;
  const models::Setup setup = load_scene(context, spec.scene, spec.set);
  add_figures(spec, extent, context.full, all, setup, result);
  Series ships{.name = "as it ships", .mark = Mark::points, .paper = true};
  for (const Point& point : points)
    if (is_default(point, setup)) ships.add(point.yards, point.error * 1e6);

  Table table{spec.benchmark + "_work_precision",
              "Error against run time",
              {"form", "integrator", "timestep_us", "error_um", "yardsticks a tick", "cpu_s_per_s",
               "times_real_time", "failure"}};
  const std::vector<CostCurve> curves = work_curves(extent, points, table);
  Plot plot = cost_beside_error(
      {.id = spec.benchmark + "_work_precision",
       .title = "Error against run time: " + spec.scene,
       .x_label = "CPU time of a tick over a fixed piece of work",
       .y_label = "error of the tip's path (um rms)",
       .caption = fmt::format(
           "True tip against the converged run of the same form; time steps 1 ms (left) to {:g} us (right). "
           "{:g} um is what this benchmark needs. What failed stands at the upper edge.",
           extent.forms.front().steps.back() * 1e6, spec.accuracy * 1e6)},
      curves, {{"allowed", spec.accuracy * 1e6}});
  plot.series.push_back(std::move(ships));
  result.plots.push_back(std::move(plot));
  result.tables.push_back(std::move(table));
}

}  // namespace enc::bench
