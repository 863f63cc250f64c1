// Error against run time of what a hand feels: the true force on what is held, over integrators and time
// steps, judged by a converged run (trial/precision). For the benchmarks that a hand touches something in.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/kit/kit.h"
#include "trial/precision/precision.h"

namespace enc::bench {

// What the force may be off by, N rms. Chosen: three counts of the hexapod's sensor, and what the arm's
// friction hides anyway. Where two converged runs do not agree so well themselves, twice what they differ
// by: all are judged by both of them.
inline constexpr double kForceAccuracy = 0.06;
[[nodiscard]] double accuracy_of(const trial::Precision& all, double wanted = kForceAccuracy);

struct ForceStudy {
  std::string scene;
  trial::Precision all{};
  double simulated = 0.0;  // s
};
// On this thread alone: it measures time.
[[nodiscard]] ForceStudy force_study(const BenchContext& context, const std::string& scene,
                                     const std::vector<std::string>& set,
                                     const trial::PrecisionOptions& options);

// A curve for each integrator, and what ships with a mark of its own.
[[nodiscard]] Plot force_plot(Plot plot, const std::vector<trial::PrecisionPoint>& points,
                              double trial::PrecisionPoint::*cost);

// What is compared, in words and in its unit. By default the force.
struct PrecisionNorm {
  std::string of = "the force", unit = "N";
  double scale = 1.0;  // of that unit in one of the study
  // In the study's unit; more where two converged runs differ by half of it.
  double accuracy = kForceAccuracy;
  trial::QuantitiesOf quantities{};
};

// The diagram, the table and the figures of a benchmark's own scene: what ships must hold the accuracy and be
// at most 1.25 times as dear as the cheapest that does. By default a small form, of two steps; with --full
// four steps and integrators, and how far three runs' costs lie apart; with --quick nothing.
void add_force_precision(Bench& bench, const std::vector<std::string>& set = {},
                         const PrecisionNorm& norm = {});

// Error against run time: one run repeated over the form of the hexapod, the integrator and the time step,
// each judged by a converged run of the same form. Failures are points, too.

struct WorkSpec {
  std::string benchmark;         // first token of the ids
  std::string scene;             // in models/scenes, without ".toml"
  std::vector<std::string> set;  // the run itself, without step, integrator and form
  double seconds = kUnset;       // s, of experiment; unset: until the scene's programme is over
  double accuracy = kUnset;      // m rms of the true tip's path: what this benchmark needs
};

// The default step and integrator of each form must meet the accuracy, and of the control form no point that
// meets it may be much cheaper. With elastic legs (the structural form) it is judged with --full alone, and
// may err by as much more as two converged runs differ by. Throws Error where the converged run fails. Runs
// alone on one core: it measures time. By default a small form of some seconds, which judges the default
// alone; with --full all of it.
void add_work_precision(const WorkSpec& spec, const BenchContext& context, BenchResult& result);

}  // namespace enc::bench
