// Is what is felt of the ball that of the time step, or of the ball? The same hands at the step that ships
// and at a converged one.
#include <fmt/format.h>

#include "benchmarks/indentation/indentation.h"

namespace enc::bench::indentation {

void add_converged(const IndentStudy& study, BenchResult& result) {
  if (study.context.quick) return;
  const std::size_t hands = 3, which = study.context.full ? indentations().size() : 1;
  for (std::size_t i = 0; i < which; ++i) {
    const Indentation& indentation = indentations().at(i);
    const auto runs = [&](const Words& own) {
      const std::vector<IndentRun> all = indent_runs(
          indent_setup(study.context.models, indentation, own, study.context.set), study.seed, hands);
      for (const IndentRun& run : all) result.simulated += run.simulated;
      return all;
    };
    const std::vector<IndentRun> ships = runs({}),
                                 fine = runs({"truth.world.timestep_us=20", "truth.world.integrator=rk4"});
    for (const bool press : {true, false}) {
      const double is = cell_of(ships, Reading::truth, press).rmse,
                   converged = cell_of(fine, Reading::truth, press).rmse;
      result.figures.push_back(
          {fmt::format("indentation.converged.{}.{}", indentation.name, press ? "press" : "release"), kUnset,
           is / converged, "x", Role::ours, 0.95, 1.05,
           fmt::format("true force against the curve, {:.4f} N rms at the step that ships, {:.4f} N at 20 us",
                       is, converged)});
    }
  }
}

}  // namespace enc::bench::indentation
