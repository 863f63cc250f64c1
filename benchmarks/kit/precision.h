// Error against run time of the force on the hand: the true force of the held tool or finger over integrators
// and time steps, judged by a converged run (trial/precision). For benchmarks in which a hand touches
// something.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/kit.h"
#include "trial/precision/precision.h"

namespace enc::bench {

// Largest error of the force, N rms. Chosen: 2.4 quantisation steps of the hexapod's force sensor, and about
// the arm's friction at the tip. If two converged runs differ by more than half of this value, the bound is
// twice their difference: both of them judge all settings.
inline constexpr double kForceAccuracy = 0.06;
[[nodiscard]] double accuracy_of(const trial::Precision& all, double wanted = kForceAccuracy);

struct ForceStudy {
  std::string scene;
  trial::Precision all{};
  double simulated = 0.0;  // s
};
// Runs on this thread alone, because it measures time.
[[nodiscard]] ForceStudy force_study(const BenchContext& context, const std::string& scene,
                                     const std::vector<std::string>& set,
                                     const trial::PrecisionOptions& options);

// A curve for each integrator; the shipped setting has its own mark, each level a line.
[[nodiscard]] Plot force_plot(Plot plot, const std::vector<trial::PrecisionPoint>& points,
                              double trial::PrecisionPoint::*cost, const std::vector<ErrorLevel>& levels);

// The compared quantity, in words and in its unit. By default the force.
struct PrecisionNorm {
  std::string of = "the force", unit = "N";
  double scale = 1.0;  // factor from the study's unit to `unit`
  // Accuracy in the study's unit; larger if two converged runs differ by more than half of it.
  double accuracy = kForceAccuracy;
  trial::QuantityMaker quantities{};
};

// Adds the diagram, the table and the figures of a benchmark's own scene. The shipped setting must hold the
// accuracy and cost at most 1.25 times as much as the cheapest that holds it. By default two steps; with
// --full four steps and integrators, and the spread of three runs' costs; with --quick nothing.
void add_force_precision(Bench& bench, const std::vector<std::string>& set = {},
                         const PrecisionNorm& norm = {});

// Error against run time: one run repeated over the form of the hexapod, the integrator and the time step,
// each judged by a converged run of that form. A failure is a point, too.

struct WorkSpec {
  std::string benchmark;         // first token of the ids
  std::string scene;             // file in models/scenes, without ".toml"
  std::vector<std::string> set;  // settings of the run itself, without step, integrator and form
  double seconds = kUnset;       // s, of experiment; unset: until the scene's programme ends
  double accuracy = kUnset;      // m rms of the true tip's path: required by this benchmark
  // False: on elastic legs the tip takes one of several courses, whatever the step, so that their path has no
  // bound here.
  bool elastic_bounded = true;
};

// The default step and integrator of each form must meet the accuracy, and no point of the control form that
// meets it may be much cheaper. Elastic legs (the structural form) are judged with --full alone; the
// difference of two converged runs is added to their bound, if they have one. Throws Error if the converged
// run fails. Runs alone on one core, because it measures time. By default a small sweep of some seconds
// judges the default alone; --full runs all of it.
void add_work_precision(const WorkSpec& spec, const BenchContext& context, BenchResult& result);

}  // namespace enc::bench
