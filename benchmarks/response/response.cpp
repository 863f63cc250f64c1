// How well a response says what a ball does where the direction changes: both models, fitted to one full loop
// alone, against the plant on minor loops; and what an admittance needs of them: no jump, no free energy,
// little force for a tremor. Nothing here runs in a world: it is the model alone.
#include "core/shape/response/response.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/kit/kit.h"
#include "core/control/scene/scene.h"
#include "models/identify/response/loop_fit.h"
#include "models/setup/scene_file.h"
#include "sim/bodies/ball_plant.h"
#include "trial/measure/record_table.h"

namespace enc::bench::response {
namespace {

constexpr double kLimit = 6e-3;   // m
constexpr double kSpeed = 4e-3;   // m/s
constexpr double kPeriod = 1e-3;  // s

// From one deflection to the next, m, in equal steps of about this size.
void walk(std::vector<double>& path, double from, double to, double step) {
  const auto steps = std::max(1L, std::lround(std::abs(to - from) / step));
  for (long i = 1; i <= steps; ++i)
    path.push_back(from + (to - from) * static_cast<double>(i) / static_cast<double>(steps));
}

// Deflections, m, from 0 along the turns (mm) at kSpeed, a reading each kPeriod.
std::vector<double> path_of(const std::vector<double>& turns) {
  std::vector<double> path;
  double at = 0.0;
  for (const double turn : turns) {
    walk(path, at, turn * 1e-3, kSpeed * kPeriod);
    at = turn * 1e-3;
  }
  return path;
}

struct MinorLoop {
  const char* name;
  std::vector<double> turns;  // mm
};
const std::array<MinorLoop, 3>& minor_loops() {
  static const std::array<MinorLoop, 3> kLoops{{{"0_4_2_4_0", {4, 2, 4, 0}},
                                                {"0_5_3_6_1_4_0", {5, 3, 6, 1, 4, 0}},
                                                {"nested", {6, 2, 5, 3, 4.5, 3.5, 4.2, 1, 3, 0.5, 2, 0}}}};
  return kLoops;
}

// The ball, one press after another; `force` gives N at the next deflection.
struct Ball {
  sim::BallPlant plant{};
  sim::BallPlantState state{};
  double force(double d) { return plant.step(state, d, kPeriod); }
};

// A plant of another structure, for information: Bouc-Wen hysteresis that scales with an elastic force, and
// one relaxing branch. Numbers are chosen to give about the ball's force and loss.
struct BoucWen {
  double d = 0.0, z = 0.0, q = 0.0;
  static double elastic(double d) { return 1.5e3 * (std::hypot(d, 0.4e-3) - 0.4e-3) + 7e6 * d * d * d; }
  double force(double to) {
    constexpr double kTravel = 0.5e-3;  // m
    constexpr double kShare = 0.09;     // of the elastic force
    constexpr double kRelaxing = 0.06;
    constexpr double kTime = 0.4;  // s
    const double step = to - d;
    z += (step - 0.5 * std::abs(step) * z - 0.5 * step * std::abs(z)) / kTravel;
    q = q * std::exp(-kPeriod / kTime) + kRelaxing * (elastic(to) - elastic(d));
    d = to;
    return std::max(0.0, elastic(d) * (1.0 + kShare * z) + q);
  }
};

template <class Plant>
double error_on(const Response& response, const std::vector<double>& path, Plant plant) {
  ResponseState state;
  double sum = 0.0;
  for (const double d : path) sum += std::pow(response.force(state, d) - plant.force(d), 2);
  return std::sqrt(sum / static_cast<double>(path.size()));
}

// Largest force change from one tick to the next on the minor loops.
double largest_change(const Response& response) {
  double most = 0.0;
  for (const MinorLoop& loop : minor_loops()) {
    ResponseState state;
    double before = 0.0;
    for (const double d : path_of(loop.turns)) {
      const double force = response.force(state, d);
      most = std::max(most, std::abs(force - before));
      before = force;
    }
  }
  return most;
}

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11U) * 0x1p-53;
}

// Peak to peak of the force while a hand at rest trembles by +-30 um, wherever it rests, reached by pressing
// or by releasing from the limit.
double tremor(const Response& response) {
  constexpr double kTremor = 30e-6;
  std::mt19937_64 random(3);
  double most = 0.0;
  constexpr double kStep = 0.05e-3;  // m
  const auto places = static_cast<int>((response.limit() - kTremor) / kStep);
  for (int i = 2; i <= places; ++i) {
    const double rest = i * kStep;
    for (const double from : {rest, response.limit()}) {
      ResponseState state;
      response.force(state, from);
      response.force(state, rest);
      double low = INFINITY;
      double high = -INFINITY;
      for (int n = 0; n < 2000; ++n) {
        const double force = response.force(state, rest + uniform(random, -kTremor, kTremor));
        low = std::min(low, force);
        high = std::max(high, force);
      }
      most = std::max(most, high - low);
    }
  }
  return most;
}

// Least energy that the object takes in over a random closed path, cycled twice before, J, by the trapezoid.
double least_absorbed(const Response& response, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  double least = INFINITY;
  for (int n = 0; n < 1000; ++n) {
    const double base = uniform(random, 0.0, kLimit);
    std::vector<double> path;
    double at = base;
    for (auto turns = static_cast<int>(uniform(random, 2.0, 10.0)); turns >= 0; --turns) {
      const double to = turns == 0 ? base : uniform(random, 0.0, kLimit);
      walk(path, at, to, uniform(random, 1e-6, 10e-6));
      at = to;
    }
    ResponseState state;
    double d = base;
    double force = response.force(state, d);
    double work = 0.0;
    for (int cycle = 0; cycle < 3; ++cycle) {
      work = 0.0;
      for (const double to : path) {
        const double now = response.force(state, to);
        work += 0.5 * (force + now) * (to - d);
        d = to;
        force = now;
      }
    }
    least = std::min(least, work);
  }
  return least;
}

ResponseSpec fitted(const std::string& csv, double floor, double ceiling = kUnset) {
  return models::fit_loop(models::parse_loop(csv, "loop", kLimit), {kLimit, floor, ceiling}).response;
}

// Force over deflection on a minor loop, each 40 um.
template <class Force>
Series loop_series(const char* name, const MinorLoop& loop, Force force) {
  constexpr std::size_t kEach = 10;
  Series series{name, {}, {}};
  const std::vector<double> path = path_of(loop.turns);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double now = force(path[i]);
    if (i % kEach != 0 && i + 1 != path.size()) continue;
    series.x.push_back(path[i] * 1e3);
    series.y.push_back(now);
  }
  return series;
}

// A full loop of the second plant.
std::string second_loop_csv() {
  std::string text = "time_s,deflection_mm,force_N,repeat\n";
  BoucWen plant;
  double t = 0.0;
  for (const double d : path_of({6, 0}))
    text += fmt::format("{:.3f},{:.6f},{:.6f},1\n", t += kPeriod, d * 1e3, plant.force(d));
  return text;
}

// A way to answer where the direction changes, and what is asked of it.
struct Model {
  const char* name;
  Reversal reversal;
  double most_error, most_tremor;  // N
};
constexpr std::array<Model, 2> kModels{{{"energy_stop", Reversal::energy_stop, kUnset, 0.2},
                                        {"prandtl_ishlinskii", Reversal::prandtl_ishlinskii, 0.08, kUnset}}};

void minor_loop_plot(Bench& bench, const ResponseSpec& ball, double floor) {
  const MinorLoop& drawn = minor_loops()[1];
  Ball plant;
  std::vector<Series> all{loop_series("plant of the ball", drawn, [&](double d) { return plant.force(d); })};
  for (const Model& m : kModels) {
    const Response response(ball, floor, m.reversal);
    ResponseState state;
    all.push_back(loop_series(m.name, drawn, [&](double d) { return response.force(state, d); }));
  }
  bench.plot(
      {.id = "minor_loop",
       .title = "Force where the direction changes: 0-5-3-6-1-4-0 mm",
       .x_label = "deflection (mm)",
       .y_label = "force (N)",
       .series = all,
       .caption = "Both models know only the full loop 0-6-0; what they do inside of it is predicted."});
}

void judge(Bench& bench, const Model& m, const Response& response, const Response& of_second) {
  const auto id = [&](const std::string& what) { return fmt::format("{}.{}", m.name, what); };
  for (const MinorLoop& loop : minor_loops()) {
    const std::vector<double> path = path_of(loop.turns);
    bench.result.simulated += static_cast<double>(path.size()) * kPeriod;
    bench.figure(id(fmt::format("minor_{}.rmse", loop.name)), error_on(response, path, Ball{}), "N",
                 at_most(m.most_error),
                 "against the plant at 4 mm/s; the shipped response knows the rig's pushes 0-6-0 alone");
    bench.figure(id(fmt::format("second_plant_{}.rmse", loop.name)), error_on(of_second, path, BoucWen{}),
                 "N", "Bouc-Wen with relaxation, fitted to its own 0-6-0: for information");
  }
  bench.figure(id("change.max"), largest_change(response), "N", at_most(0.03),
               "force from one 1 ms cycle to the next at 4 mm/s");
  bench.figure(id("tremor.pp"), tremor(response), "N", at_most(m.most_tremor),
               "+-30 um at rest, the worst of all deflections and both branches");
  bench.figure(id("absorbed.min"), least_absorbed(response, bench.context.seed) * 1e3, "mJ", at_least(-1e-3),
               "1,000 random closed paths, cycled twice first");
}

// The price of quiet stops: a passive force turns fastest at once, so what is quiet for a tremor turns late.
void quiet_stops(Bench& bench, double floor) {
  constexpr double kQuiet = 0.2 / 60e-6;  // N/m: 0.2 N for 60 um
  const models::Setup rig = models::load(bench.context.models + "/scenes/rig_A.toml", "sim");
  const Response quiet(fitted(trial::table_of_run(rig, 1), floor, kQuiet), floor,
                       Reversal::prandtl_ishlinskii);
  double worst = 0.0;
  for (const MinorLoop& loop : minor_loops())
    worst = std::max(worst, error_on(quiet, path_of(loop.turns), Ball{}));
  bench.figure("quiet_stops.tremor.pp", tremor(quiet), "N", at_most(0.2),
               "stops fitted with --ceiling-N-per-mm 3.333");
  bench.figure("quiet_stops.minor.rmse", worst, "N", "worst minor loop of these: the price");
}

void run(Bench& bench) {
  const std::string& folder = bench.context.models;
  const double floor = models::fit_floor(loop_of(models::load_rig(folder + "/rigs/sim.toml")));
  const ResponseSpec ball = models::load_response(folder + "/responses/tennis_ball.toml");
  const ResponseSpec second = fitted(second_loop_csv(), floor);
  minor_loop_plot(bench, ball, floor);
  for (const Model& m : kModels) {
    judge(bench, m, Response(ball, floor, m.reversal), Response(second, floor, m.reversal));
    bench.progress(m.reversal == Reversal::energy_stop ? 0.4 : 0.8);
  }
  quiet_stops(bench, floor);
}

const Entry kEntry{"response", "loops of a ball",
                   "both response models: minor loops, jumps, tremor at rest, energy", run};

}  // namespace
}  // namespace enc::bench::response
