#include "benchmarks/plane_button/plane_button.h"

#include "benchmarks/kit/kit.h"

namespace enc::bench::plane_button {

void run(Bench& bench) {
  const BenchContext& context = bench.context;
  BenchResult& result = bench.result;
  result.note =
      "The paper prints no units on either axis: shapes are compared, all numbers are ours. Force is the "
      "contact "
      "force in the simulator, distance the true finger's.";
  const Report report(result);
  const auto progress = [&](double share) {
    if (context.progress) context.progress(share);
  };
  measure_wall(context, report);
  progress(0.3);
  measure_button(context, report);
  progress(0.6);
  measure_step(context, report);
  progress(0.8);
  if (!context.quick) measure_precision(context, report);
}

const Entry kEntry{"plane_button", "wall",
                   "force over distance, wall and button (VisHap Figs 4, 5); late finger, step, limits", run};

}  // namespace enc::bench::plane_button
