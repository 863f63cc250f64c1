// Error of the wall's curve over run time, integrators by time steps, against RK4 at 31.25 us.
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/plane_button/plane_button.h"

namespace enc::bench::plane_button {
namespace {

// A quick press by a hand that does not tremble, so that each depth has one force.
PressTrace pressed(const BenchContext& context, const std::string& integrator, double step_us) {
  return press_trace(
      context, "wall",
      live({"user.approach_mm_s=[100]", "user.approach_from_mm=40", "user.press_s=0.8", "user.hold_s=0.1",
            "user.release_s=0.2", "truth.hand.tremor_mm=0", "truth.hand.drift_mm=0",
            "truth.arm.integrator=\"" + integrator + "\"", fmt::format("truth.arm.timestep_us={}", step_us)}),
      2.0);
}

// Root of the mean square of the force's difference at the same depth, N.
double apart(const Curve& a, const Curve& b) {
  double sum = 0.0;
  const std::size_t n = std::min(a.force.size(), b.force.size());
  for (std::size_t i = 0; i < n; ++i) sum += std::pow(a.force[i] - b.force[i], 2);
  return n > 0 ? std::sqrt(sum / static_cast<double>(n)) : kUnset;
}

// Interpolated at fixed depths.
Curve sampled(const PressTrace& trace) {
  const Curve fine = curve_of(trace, sim::Phase::press, 1e-3, 10e-3, 0.05e-3);
  Curve curve;
  if (fine.depth.size() < 2) return curve;  // hardly pressed
  std::size_t at = 1;
  for (int i = 0; i < 75; ++i) {
    const double depth = 2e-3 + i * 0.1e-3;
    while (at + 1 < fine.depth.size() && fine.depth[at] < depth) ++at;
    const double share = (depth - fine.depth[at - 1]) / (fine.depth[at] - fine.depth[at - 1]);
    curve.depth.push_back(depth);
    curve.force.push_back(fine.force[at - 1] + share * (fine.force[at] - fine.force[at - 1]));
  }
  return curve;
}

}  // namespace

// Alone on one core: it measures time.
void measure_precision(const BenchContext& context, const Report& report) {
  const Curve reference = sampled(pressed(context, "rk4", 31.25));
  Plot plot{"plane_button_precision",
            "Error of the wall's curve over run time",
            "run time (us a tick)",
            "rms error of the force at a depth (N)",
            true,
            true};
  Table table{"plane_button_precision",
              "Error of the wall's curve, pressed quickly, against RK4 at 31.25 us",
              {"integrator", "step (us)", "rms error (mN)", "run time (us a tick)"},
              {}};
  for (const std::string integrator : {"rk4", "implicitfast", "euler"}) {
    Series series{integrator};
    series.mark = Mark::both;
    for (const double step : {1000.0, 500.0, 250.0, 125.0}) {
      const PressTrace trace = pressed(context, integrator, step);
      const double error = apart(sampled(trace), reference);
      const double time = 1e6 * trace.cpu / static_cast<double>(trace.run.ticks);
      series.x.push_back(time);
      series.y.push_back(error);
      table.rows.push_back({integrator, fmt::format("{:g}", step), fmt::format("{:.2f}", 1e3 * error),
                            fmt::format("{:.1f}", time)});
      if (integrator == "rk4" && step == 1000.0)
        report.figure("precision.default", 1e3 * error, "mN", "rms error of the default, RK4 at 1 ms", 0.0,
                      50.0);
    }
    plot.series.push_back(std::move(series));
  }
  plot.caption = "Same law, held at 1 kHz; only the physics between two ticks is solved more finely.";
  report.result().plots.push_back(std::move(plot));
  report.result().tables.push_back(std::move(table));
}

}  // namespace enc::bench::plane_button
