// Error against run time over the whole twin: what each time step and integrator makes of the force on what
// is held, in scenes of both machines, and what it costs; beside what ships.
#include "trial/precision/precision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/force_precision.h"
#include "benchmarks/kit/kit.h"
#include "benchmarks/precision/parts.h"

namespace enc::bench::precision {
namespace {

struct Machine {
  const char* name;
  std::vector<std::string> scenes;
};
const std::array<Machine, 2>& machines() {
  static const std::array<Machine, 2> kMachines{
      Machine{"hexapod", {"session", "training", "tennis_ball", "plane", "stiffness"}},
      Machine{"arm", {"reaching", "wall", "keypad", "tiles", "drum", "button", "hit_ball", "room"}}};
  return kMachines;
}

ForceStudy study_of(const BenchContext& context, const std::string& scene) {
  trial::PrecisionOptions options;
  options.rounds = context.full ? 3 : 1;
  return force_study(context, scene, {}, options);
}

// Of all scenes of a machine, which share one rig: the worst error of each setting, over what its scene shall
// hold, and its cost over that of what ships, the median of the scenes.
std::vector<trial::PrecisionPoint> together(const std::vector<ForceStudy>& studies) {
  std::vector<trial::PrecisionPoint> all = studies.front().all.points;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<double> cost;
    all[i].error = 0.0;
    for (const ForceStudy& study : studies) {
      const std::vector<trial::PrecisionPoint>& points = study.all.points;
      const trial::PrecisionPoint* shipped = trial::shipped(points);
      const trial::PrecisionPoint& point = points[i];
      if (!point.failure.empty()) all[i].failure = study.scene + ": " + point.failure;
      all[i].error = std::max(all[i].error, point.error / accuracy_of(study.all));
      if (shipped != nullptr) cost.push_back(point.cost() / shipped->cost());
    }
    all[i].cpu = cost.empty() ? kUnset : median(cost);
    all[i].yards = kUnset;
  }
  return all;
}

void add_plot(Bench& bench, const Machine& machine, const std::vector<trial::PrecisionPoint>& all) {
  bench.plot(force_plot(
      {.id = machine.name,
       .title =
           fmt::format("Error against run time: {} scenes of the {}", machine.scenes.size(), machine.name),
       .x_label = "CPU time over that of what ships",
       .y_label = "force error over what a scene shall hold",
       .caption = fmt::format("True force while something touches, against a converged run of the same hand; "
                              "steps of a whole haptic period (left) to an eighth (right). A scene shall "
                              "hold {:g} N, or twice what two converged runs differ by. What failed "
                              "stands at the upper edge.",
                              kForceAccuracy)},
      all, &trial::PrecisionPoint::cpu));
}

void add_machine(Bench& bench, const Machine& machine, const std::vector<ForceStudy>& studies, Table& table) {
  for (const ForceStudy& study : studies) {
    const auto& points = study.all.points;
    for (const trial::PrecisionPoint& point : points)
      table.add(study.scene, point.integrator, fmt::format("{:g}", point.step * 1e6),
                point.failure.empty() ? fmt::format("{:.4f}", point.error) : "",
                point.failure.empty() ? fmt::format("{:.2f}", point.way * 1e6) : "",
                fmt::format("{:.0f}", 1.0 / point.cpu), point.shipped ? "ships" : "", point.failure);
    const trial::PrecisionPoint* shipped = trial::shipped(points);
    if (shipped == nullptr) continue;  // --set has put another step in its place
    bench.figure(study.scene + ".error.rms", shipped->error, "N", at_most(accuracy_of(study.all)),
                 fmt::format("force at what ships, {} at {:g} us; two converged runs differ by {:.4f} N",
                             shipped->integrator, shipped->step * 1e6, study.all.second.error));
    bench.figure(study.scene + ".path.rms", shipped->way * 1e6, "um",
                 fmt::format("the tip's path; the two by {:.2f}", study.all.second.way * 1e6));
  }
  const std::vector<trial::PrecisionPoint> all = together(studies);
  const trial::PrecisionPoint* best = cheapest(all, {1.0});
  const trial::PrecisionPoint* shipped = trial::shipped(all);
  add_plot(bench, machine, all);
  if (shipped == nullptr || bench.context.quick) return;  // of one scene it says nothing
  bench.cost(fmt::format("{}.default_over_cheapest.cpu", machine.name),
             best != nullptr ? 1.0 / best->cpu : kUnset, "x",
             best != nullptr
                 ? fmt::format("the cheapest setting that all of its scenes hold with: {} at {:g} us",
                               best->integrator, best->step * 1e6)
                 : "no setting holds in all of its scenes");
}

void run(Bench& bench) {
  Table table{
      "points",
      "Error against run time",
      {"scene", "integrator", "timestep_us", "force_N", "path_um", "times_real_time", "ships", "failure"},
      {}};
  std::vector<std::string> scenes;
  for (const Machine& machine : machines())
    for (const std::string& scene : machine.scenes)
      if (!bench.context.quick || scene == machine.scenes.back()) scenes.push_back(scene);
  const std::vector<ForceStudy> studies =
      bench.each(scenes, [&](const std::string& scene) { return study_of(bench.context, scene); });
  for (const Machine& machine : machines()) {
    std::vector<ForceStudy> own;
    for (const ForceStudy& study : studies)
      if (std::find(machine.scenes.begin(), machine.scenes.end(), study.scene) != machine.scenes.end())
        own.push_back(study);
    add_machine(bench, machine, own, table);
  }
  bench.table(std::move(table));
  add_orders(bench);
  if (bench.context.full) add_advice(bench, studies);
}

const Entry kEntry{"precision", "the twin", "error against run time, both machines: integrator and time step",
                   run};

}  // namespace
}  // namespace enc::bench::precision
