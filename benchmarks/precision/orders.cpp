#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/precision/parts.h"
#include "trial/trial.h"

namespace enc::bench::precision {
namespace {

constexpr double kGlance = 8e-3;  // s, between two places of a fall
constexpr int kGlances = 25;

// A hand on its way to an object, and the machine that goes to meet it. Encoders that count finely and
// friction without a jump leave nothing in it that is not smooth.
struct Smooth {
  const char* name;
  const char* scene;
  const char* table;  // where its step stands
  double seconds;     // s: nothing touches before
  std::vector<std::string> set;
};
const std::array<Smooth, 2>& smooth() {
  static const std::array<Smooth, 2> kSmooth{
      Smooth{"hand", "tennis_ball", "truth.world", 1.0, {}},
      Smooth{"arm",
             "wall",
             "truth.arm",
             1.0,
             {"truth.arm.friction_form=smooth", "truth.arm.counts=[1e9, 1e9, 1e9]"}}};
  return kSmooth;
}

struct Way {
  std::vector<Vec3> at;  // of the tool's tip, and of an arm's in turn; a hexapod steps by microns: of its
                         // scene the hand alone
  bool touched = false;
};

// The arm falls by itself, its motors and friction left out: nothing but MuJoCo's own step.
Way falling(const BenchContext& context, const std::string& integrator, double step) {
  trial::Trial trial(
      load_scene(context, "wall", {"truth.arm.friction_form=smooth", "truth.arm.integrator=" + integrator}),
      {.seconds = 1.0});
  sim::Physics& physics = trial.world().physics();
  physics.model()->opt.timestep = step;
  const int tip = physics.id(mjOBJ_BODY, "prop");
  const auto steps = std::lround(kGlance / step);
  Way way;
  for (int glance = 0; glance < kGlances; ++glance) {
    for (int i = 0; i < steps; ++i) mj_step(physics.model(), physics.data());
    mj_kinematics(physics.model(), physics.data());
    way.at.emplace_back(physics.data()->xpos + 3 * tip);
  }
  return way;
}

Way way_of(const BenchContext& context, const Smooth& smooth, const std::string& integrator, double step) {
  Way way;
  std::vector<std::string> set = smooth.set;
  set.push_back(fmt::format("{}.timestep_us={:g}", smooth.table, step * 1e6));
  set.push_back(fmt::format("{}.integrator={}", smooth.table, integrator));
  trial::TrialOptions options;
  options.seed = context.seed;
  options.seconds = smooth.seconds;
  options.watch = [&](const trial::Glance& glance) {
    way.at.push_back(glance.truth.tool_tip.e());
    if (glance.scene.impedance() != nullptr) way.at.push_back(glance.truth.tip.e());
    way.touched = way.touched || glance.truth.touching;
  };
  trial::Trial trial(load_scene(context, smooth.scene, set), options);
  trial.run();
  return way;
}

// The path that a step of nothing would give. Where the twin takes a hand and a servo once a step, RK4 has an
// error of the first order too: two steps tell how large it is, and what is left is of the second.
template <class WayWith>
Way converged(const WayWith& way_with, double coarse, bool alone) {
  Way fine = way_with("rk4", coarse / 40.0);
  if (alone) return fine;
  const Way finer = way_with("rk4", coarse / 80.0);
  fine.touched = fine.touched || finer.touched;
  for (std::size_t i = 0; i < fine.at.size(); ++i) fine.at[i] = 2.0 * finer.at.at(i) - fine.at[i];
  return fine;
}

double apart(const Way& a, const Way& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.at.size(); ++i) sum += (a.at[i] - b.at.at(i)).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.at.size()));
}

}  // namespace

void add_orders(Bench& bench) {
  constexpr double kRounding = 1e-15;  // m
  Table table{
      "orders", "Error of a path without contact", {"path", "integrator", "timestep_us", "error_um"}, {}};
  const auto fit = [&](const std::string& path, const std::string& integrator, const auto& way_with,
                       bool alone) {
    const double coarse = alone ? kGlance : 1e-3;
    const Way truth = converged(way_with, coarse, alone);
    std::vector<double> steps, errors;
    for (const double parts : {1.0, 2.0, 4.0, 8.0}) {
      steps.push_back(coarse / parts);
      const Way way = way_with(integrator, steps.back());
      errors.push_back(way.touched || truth.touched ? kUnset : apart(way, truth));
      table.add(path, integrator, fmt::format("{:g}", steps.back() * 1e6),
                fmt::format("{:.3g}", errors.back() * 1e6));
    }
    const bool fourth = integrator == "rk4" && alone;
    bench.figure(fmt::format("order.{}.{}", path, integrator), fitted_order(steps, errors, kRounding), "",
                 fourth ? at_least(3.5) : between(0.9, 1.1),
                 alone ? "power of the step with which the error falls: an arm that falls, by itself"
                       : "a hand on its way and the machine that goes to meet it: what the twin adds to the "
                         "physics is taken once a step");
  };
  for (const std::string& integrator : trial::Grid{}.integrators) {
    fit(
        "fall", integrator,
        [&](const std::string& with, double step) { return falling(bench.context, with, step); }, true);
    for (const Smooth& one : smooth())
      fit(
          one.name, integrator,
          [&](const std::string& with, double step) { return way_of(bench.context, one, with, step); },
          false);
  }
  bench.table(std::move(table));
}

}  // namespace enc::bench::precision
