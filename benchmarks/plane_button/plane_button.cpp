#include "benchmarks/plane_button/plane_button.h"

namespace enc::bench::plane_button {

BenchResult run(const BenchContext& context) {
  BenchResult result{"plane_button", "wall", 0, 0, {}, {}};
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
  return result;
}

}  // namespace enc::bench::plane_button
