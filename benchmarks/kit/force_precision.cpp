#include "benchmarks/kit/force_precision.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/yardstick.h"

namespace enc::bench {
namespace {

// Orders as they are found: no bounds, as a contact is not smooth.
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
                double trial::PrecisionPoint::*cost) {
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
  return cost_beside_error(std::move(plot), curves);
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
  const double accuracy = accuracy_of(all, norm.accuracy);
  const auto told = [&](double error) { return fmt::format("{:.4f} {}", error * norm.scale, norm.unit); };
  const bool of_force = !norm.quantities;
  Table table{"precision",
              fmt::format("Error of {} against run time", norm.of),
              {"integrator", "timestep_us", of_force ? "force_N" : "error_percent", "path_um",
               "yardsticks a tick", "times_real_time", "ships", "failure"},
              {}};
  for (const trial::PrecisionPoint& point : all.points) {
    const bool there = point.failure.empty();
    table.add(point.integrator, fmt::format("{:g}", point.step * 1e6),
              there ? fmt::format("{:.4f}", point.error * norm.scale) : "",
              there ? fmt::format("{:.2f}", point.way * 1e6) : "", fmt::format("{:.2f}", point.yards),
              fmt::format("{:.0f}", 1.0 / point.cpu), point.shipped ? "ships" : "", point.failure);
  }
  table.note = "orders found: " + orders_text(all);
  bench.table(std::move(table));
  std::vector<trial::PrecisionPoint> scaled = all.points;
  for (trial::PrecisionPoint& point : scaled) point.error *= norm.scale;
  bench.plot(force_plot(
      {.id = "precision",
       .title = fmt::format("Error of {} against run time: {}", norm.of, study.scene),
       .x_label = "CPU time of a tick over a fixed piece of work",
       .y_label = fmt::format("error of {} ({})", norm.of, norm.unit == "N" ? "N rms" : norm.unit),
       .caption = fmt::format("{}, against a converged run of the same hand ({:g} s of it). Two converged "
                              "runs differ by {}; {} is what this shall hold. What failed stands at the "
                              "upper edge.",
                              of_force ? "True force while something touches"
                                       : "The greatest difference, over the greatest value",
                              all.seconds, told(all.second.error), told(accuracy))},
      scaled, &trial::PrecisionPoint::yards));
  const trial::PrecisionPoint* shipped = trial::shipped(all.points);
  if (shipped == nullptr) return;
  bench.figure(of_force ? "precision.error.rms" : "precision.error.max", shipped->error * norm.scale,
               norm.unit.c_str(), at_most(accuracy * norm.scale),
               fmt::format("{} at what ships, {} at {:g} us; two converged runs differ by {}", norm.of,
                           shipped->integrator, shipped->step * 1e6, told(all.second.error)));
  if (!bench.context.full) return;
  const trial::PrecisionPoint* best = cheapest(all.points, {accuracy});
  bench.cost(
      "precision.default_over_cheapest.cpu", best != nullptr ? shipped->yards / best->yards : kUnset, "x",
      best != nullptr ? fmt::format("cheapest that holds: {} at {:g} us", best->integrator, best->step * 1e6)
                      : "nothing holds it");
  bench.cost("precision.spread.max", shipped->spread, "x",
             "yardsticks of what ships, the greatest over the least of three runs");
}

}  // namespace enc::bench
