// Studies beside Table 2: the time of a press, more exact devices, and directions without measured curves.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "benchmarks/indentation/indentation.h"
#include "benchmarks/kit/parallel.h"
#include "benchmarks/kit/precision.h"
#include "benchmarks/stiffness/push_study.h"
#include "core/control/task/indentation/indentation.h"
#include "core/control/track/reach.h"
#include "core/machine/loop_model.h"
#include "models/directions/directions.h"
#include "models/identify/response/loop_csv.h"
#include "sim/bodies/ball_plant.h"
#include "trial/measure/record_table.h"
#include "trial/trial.h"

namespace enc::bench::indentation {
namespace {

// A set of devices that follows the reference curves more closely than the paper's, and its cost: a higher
// force filter lets noise through and makes soft objects unstable.

// Half of the filter's lag, and a threshold that the quieter of two sensors would allow. The ball's softest
// slope is then below the lowest stable stiffness of a firm grip; the scene renders it all the same.
const Words kAccuracy{"rig.force.filter_hz=10", "rig.force.threshold_N=0.03",
                      "rig.contact.softest_N_per_mm=0"};

struct Rest {
  double tip = kUnset, force = kUnset;  // m, N: peak to peak, along the normal, of a tool held still
};

// Noise while a hand without tremor holds the ball at half of its depth.
Rest rest_of(const IndentStudy& study, const Words& own) {
  Words set = own;
  set.insert(set.end(), still_hand().begin(), still_hand().end());
  set.insert(set.end(), {"user.depth_mm=3", "user.press_s=2", "user.hold_s=4", "user.release_s=1"});
  const models::Setup setup =
      indent_setup(study.context.models, indentations().front(), set, study.context.set);
  constexpr double kSettled = 2.0;  // s of the hold
  std::vector<double> tip, force;
  double held = 0.0;
  trial::TrialOptions options{.seed = study.seed};
  options.watch = [&](const trial::Glance& glance) {
    if (glance.truth.phase != sim::Phase::hold) return;
    held += glance.scene.dt;
    if (held < kSettled) return;
    tip.push_back(glance.truth.tip.xyz[2]);
    force.push_back(glance.out.force_unfiltered.xyz[2]);
  };
  trial::Trial(setup, options).run();
  if (tip.empty()) return {};
  return {stiffness::peak_to_peak(tip), stiffness::peak_to_peak(force)};
}

struct Price {
  double grip = kUnset,
         pusher = kUnset;  // N/m: lowest stable stiffness against a firm grip and a soft pusher
  Rest rest;
};
Price price_of(const IndentStudy& study, const Words& own) {
  const models::Setup setup =
      indent_setup(study.context.models, indentations().front(), own, study.context.set);
  return {lowest_stable_stiffness(loop_of(setup.rig)), lowest_stable_stiffness(stiffness::pushed_loop(setup)),
          rest_of(study, own)};
}

void add_price(const IndentStudy& study, const std::vector<Cell>& standard, const std::vector<Cell>& accurate,
               BenchResult& result) {
  Table table{
      "indentation_price",
      "What accuracy costs",
      {"devices", "largest RMSE of a consistent cell over the paper's", "lowest stable against a grip (N/mm)",
       "against a soft pusher (N/mm)", "tip at rest, peak to peak (um)", "force at rest, peak to peak (N)"},
      {},
      "Lowest stable stiffness of the linear loop (core/machine/loop_model.h); at rest: held at 3 mm by a "
      "hand without tremor, force before the filter."};
  for (const auto& [name, set, cells] :
       {std::tuple{"as shipped", Words{}, &standard}, std::tuple{"set for accuracy", kAccuracy, &accurate}}) {
    const Price price = price_of(study, set);
    double worst = 0.0;
    for (std::size_t i = 0; i < kCells; ++i)
      if (study.paper[i].consistent) worst = std::max(worst, (*cells)[i].rmse / study.paper[i].rmse);
    table.rows.push_back({name, fixed(worst, 2), fixed(price.grip * 1e-3, 3), fixed(price.pusher * 1e-3, 4),
                          fixed(price.rest.tip * 1e6, 1), fixed(price.rest.force, 3)});
    if (cells != &accurate) continue;
    const auto add = [&](const char* id, double twin, const char* unit, const char* note) {
      result.figures.push_back(
          {fmt::format("indentation.accuracy.{}", id), kUnset, twin, unit, Role::ours, kUnset, kUnset, note});
    };
    add("grip.lowest_stable_N_per_mm", price.grip * 1e-3, "N/mm",
        "linear loop with the grip of the rig file");
    add("pusher.lowest_stable_N_per_mm", price.pusher * 1e-3, "N/mm", "linear loop with the pusher of Fig 3");
    add("tip_at_rest.pp", price.rest.tip * 1e6, "um", "peak to peak, held at 3 mm without tremor");
    add("force_at_rest.pp", price.rest.force, "N", "peak to peak, before the filter");
  }
  result.tables.push_back(std::move(table));
}

// The conflict between two figures over the devices: Table 2 needs a fast filter, Fig 3 a slow one.
void add_trade_off(const IndentStudy& study, BenchResult& result) {
  const std::vector<double> corners{2.5, 5, 7.5, 10, 20, 40};
  Plot plot{"indentation_trade_off", "Force filter: error of a press against the softest stable object",
            "corner of the force filter (Hz)", "RMSE of A's press (N); stiffness (N/mm)", true};
  Series recorded{.name = "RMSE, recorded force", .mark = Mark::both};
  Series truth{.name = "RMSE, true force", .mark = Mark::both};
  Series grip{.name = "lowest stable, firm grip (linear)", .mark = Mark::both};
  Series pusher{.name = "lowest stable, soft pusher (linear)", .mark = Mark::both};
  for (const double corner : corners) {
    models::Setup setup = indent_setup(study.context.models, indentations().front(), {}, study.context.set);
    setup.rig.force.filter = corner;
    setup.rig.contact.softest = 0.0;
    const std::vector<IndentRun> runs = indent_runs(setup, study.seed, 2);
    for (const auto& [series, y] :
         {std::pair{&recorded, cell_of(runs, Reading::recorded, true).rmse},
          std::pair{&truth, cell_of(runs, Reading::truth, true).rmse},
          std::pair{&grip, lowest_stable_stiffness(loop_of(setup.rig)) * 1e-3},
          std::pair{&pusher, lowest_stable_stiffness(stiffness::pushed_loop(setup)) * 1e-3}}) {
      series->add(corner, y);
    }
    for (const IndentRun& run : runs) result.simulated += run.simulated;
  }
  const PaperCell& paper = study.paper.front();
  plot.series = {{.name = "paper, A press",
                  .x = {corners.front(), corners.back()},
                  .y = {paper.rmse, paper.rmse},
                  .paper = true},
                 std::move(recorded),
                 std::move(truth),
                 std::move(grip),
                 std::move(pusher)};
  plot.caption =
      "A faster filter brings the true force nearer to the curve and makes soft objects unstable; nearer "
      "than the hand's own tremor and drift it cannot bring it. The recorded force is behind the filter, so "
      "the filter's lag is not in its error.";
  result.plots.push_back(std::move(plot));
}

// The softest wall that comes to rest in the whole twin, with the filter of each set.
void add_pushed(const IndentStudy& study, BenchResult& result) {
  const models::Setup setup =
      stiffness::push_setup(study.context.models, study.context.set, {kAccuracy.front()});
  stiffness::StabilityMap map(setup, study.seed, 8, 7.0 / 8.0);
  const double lowest = map.lowest_stable(lowest_stable_stiffness(stiffness::pushed_loop(setup)));
  result.figures.push_back(
      {"indentation.accuracy.pushed.lowest_stable_N_per_mm", kUnset, lowest * 1e-3, "N/mm", Role::ours,
       kUnset, kUnset,
       "whole twin with this filter: from here up 7 of 8 pushes of Fig 3's pusher come to rest"});
  result.simulated += map.simulated();
}

// Table 2 over the press time, and the theory behind it: lag x speed x slope.

models::Setup with_time(models::Setup setup, double time) {
  setup.scene.user->press_time = setup.scene.user->release_time = time;
  return setup;
}

// s: lag of the machine's position behind the filtered force. The servo lags by 2 zeta / omega. The command
// limiter takes a cycle, and the position after a command is read in the next cycle.
double servo_lag(const sim::TwinSpec& twin) {
  return 2.0 * twin.hexapod.damping / (2.0 * std::numbers::pi * twin.hexapod.servo);
}
double recorded_lag(const models::Setup& setup) {
  return servo_lag(setup.twin) +
         (static_cast<double>(setup.twin.hexapod.delay_cycles) + 2.0) / setup.rig.loop.rate;
}

// A still hand presses in the scene's press time and in half of it.
void add_lag(const IndentStudy& study, BenchResult& result) {
  const models::Setup setup =
      indent_setup(study.context.models, indentations().front(), still_hand(), study.context.set);
  const double time = setup.scene.user->press_time;
  std::array<IndentRun, 2> runs;
  in_parallel(runs.size(), [&](std::size_t i) {
    models::Setup one = with_time(setup, i == 0 ? time : 0.5 * time);
    one.scene.user->release_time = 1.0;  // the release is not evaluated
    runs[i] = indent_run(one, study.seed);
  });
  const BehaviourSpec& behaviour = setup.scene.behaviours.front();
  LagTheory theory{Response(behaviour.curves, 0.0, behaviour.reversal), Response(behaviour.curves, 0.0),
                   setup.scene.user->depth, setup.rig.force.threshold, kUnset};
  struct Way {
    const char* name;
    Reading reading;
    double lag, low, high;
  };
  const double lag = study.context.mutated("no_delay") ? servo_lag(setup.twin) : recorded_lag(setup);
  for (const Way& way : {Way{"lag", Reading::recorded, lag, 0.85, 1.15},
                         Way{"lag.sensor", Reading::sensor, sensor_lag(setup), kUnset, kUnset}}) {
    theory.lag = way.lag;
    const double slow = cell_of({runs[0]}, way.reading, true).rmse;
    const double fast = cell_of({runs[1]}, way.reading, true).rmse;
    const double predicted = predicted_rmse(theory, 0.5 * time) - predicted_rmse(theory, time);
    result.figures.push_back({fmt::format("indentation.{}.ratio", way.name), kUnset,
                              (fast - slow) / predicted, "", Role::ours, way.low, way.high,
                              fmt::format("RMSE of A's press grows from {:.4f} to {:.4f} N in {:g} instead "
                                          "of {:g} s; over what {:.1f} ms x speed x slope predict, {:.4f} N",
                                          slow, fast, 0.5 * time, time, way.lag * 1e3, predicted)});
  }
  for (const IndentRun& run : runs) result.simulated += run.simulated;
}

// Runs of all indentations with this press time, s.
IndentRuns runs_with_time(const IndentStudy& study, double time, std::size_t each) {
  IndentRuns runs;
  for (const Indentation& which : indentations())
    runs.push_back(indent_runs(
        with_time(indent_setup(study.context.models, which, {}, study.context.set), time), study.seed, each));
  return runs;
}

// %: rms of the logarithm of the twin's RMSE over the paper's, over the consistent cells.
double misfit_of_cells(const IndentStudy& study, const std::vector<Cell>& cells) {
  std::vector<double> misfit;
  for (std::size_t i = 0; i < kCells; ++i)
    if (study.paper[i].consistent) misfit.push_back(std::log(cells[i].rmse / study.paper[i].rmse));
  return 100.0 * rms(misfit);
}

// A row of the table over the press time; adds a point to the line of each cell.
std::vector<std::string> sweep_row(const IndentStudy& study, double time, const IndentRuns& runs,
                                   std::vector<Series>& lines) {
  const std::vector<Cell> cells = cells_of(runs, Reading::recorded);
  std::vector<std::string> row{fmt::format("{:g}", time)};
  for (std::size_t i = 0; i < kCells; ++i) {
    lines[i].add(time, cells[i].rmse);
    row.push_back(fixed(cells[i].rmse, 4));
  }
  row.push_back(fixed(misfit_of_cells(study, cells), 1));
  row.push_back(fixed(misfit_of_cells(study, cells_of(runs, Reading::sensor)), 1));
  return row;
}

void add_sweep(const IndentStudy& study, BenchResult& result) {
  const std::vector<double> times{3.0, 4.0, 6.0, 9.0, 13.5, 20.0};
  Plot plot{"indentation_press_time", "Table 2 over the press time, which the paper does not give",
            "press time (s)", "RMSE (N)", true};
  Table table{"indentation_press_time",
              plot.title,
              {"press time (s)"},
              {},
              "Means of the logarithms' squares over the cells that are consistent: misfit."};
  for (const PaperCell& cell : study.paper) {
    if (cell.consistent)
      plot.series.push_back({.name = fmt::format("paper, {} {}", cell.indentation, cell.way),
                             .x = {times.front(), times.back()},
                             .y = {cell.rmse, cell.rmse},
                             .paper = true});
    table.columns.push_back(fmt::format("{} {} (N)", cell.indentation, cell.way));
  }
  table.columns.emplace_back("misfit (%)");
  table.columns.emplace_back("misfit of the sensor's force (%)");
  std::vector<Series> lines;
  for (const PaperCell& cell : study.paper)
    lines.push_back({.name = fmt::format("{} {}", cell.indentation, cell.way), .mark = Mark::both});
  for (const double time : times) {
    const IndentRuns runs = runs_with_time(study, time, 2);
    table.rows.push_back(sweep_row(study, time, runs, lines));
    for (const std::vector<IndentRun>& of : runs)
      for (const IndentRun& run : of) result.simulated += run.simulated;
  }
  for (Series& line : lines) plot.series.push_back(std::move(line));
  plot.caption =
      "Slower presses have less lag; what remains is the force threshold and how far the law that is felt "
      "lies from the polynomials. Press time and release time alike.";
  result.plots.push_back(std::move(plot));
  result.tables.push_back(std::move(table));
}

// Tests without fitted data: presses between and beside A, B and C, and turns at 2 and 4 mm, against the
// rig's ball.

struct Push {
  const char* name;
  Words set;
};
// Presses between the three, in another azimuth, and beyond them.
const std::vector<Push>& pushes() {
  static const std::vector<Push> kPushes{
      {"polar_175_offset_5", {"probe.polar_deg=175", "probe.offset_mm=5"}},
      {"offset_5", {"probe.offset_mm=5"}},
      {"azimuth_90", {"probe.azimuth_deg=90", "probe.polar_deg=173", "probe.offset_mm=-5"}},
      {"polar_165", {"probe.polar_deg=165"}}};
  return kPushes;
}

// The user's settings that apply to the test rig, too.
Words of_rig(const Words& set) {
  Words kept;
  std::copy_if(set.begin(), set.end(), std::back_inserter(kept), [](const std::string& word) {
    return word.starts_with("truth.") || word.starts_with("rig.");
  });
  return kept;
}

models::PressWay way_of_probe(const SceneSpec& scene) {
  const ProbeSpec& probe = *scene.probe;
  const auto axis_at = [&](double polar) {
    return Vec3(std::sin(polar) * std::cos(probe.azimuth), std::sin(polar) * std::sin(probe.azimuth),
                std::cos(polar));
  };
  const Vec3 axis = axis_at(probe.polar);
  const Vec3 side = axis_at(probe.polar + std::numbers::pi / 2);  // towards growing polar angle
  const double turned = std::asin(probe.offset / (scene.objects.front().radius + probe.radius));
  return models::way_of(axis, std::cos(turned) * axis + std::sin(turned) * side);
}

struct Misfit {
  double rule = kUnset, nearest = kUnset;  // N rms over the whole loop: mixed curves, and A's curves alone
  std::vector<double> weights;
  double simulated = 0.0;  // s
};

double rms_of(const std::vector<std::vector<models::LoopPoint>>& presses, const Response& response) {
  double sum = 0.0, count = 0.0;
  for (const std::vector<models::LoopPoint>& press : presses) {
    ResponseState state;
    for (const models::LoopPoint& point : press) {
      if (point.deflection > response.limit()) continue;
      sum += std::pow(response.force(state, point.deflection) - point.force, 2);
      count += 1.0;
    }
  }
  return std::sqrt(sum / count);
}

Misfit misfit_of(const IndentStudy& study, const Push& push,
                 const std::vector<models::Direction>& directions) {
  Words set{"probe.repeats=1"};
  set.insert(set.end(), push.set.begin(), push.set.end());
  const Words users = of_rig(study.context.set);
  set.insert(set.end(), users.begin(), users.end());
  const models::Setup setup = models::load(study.context.models + "/scenes/rig_A.toml", "sim", set);
  std::vector<ResponseSpec> parts;
  parts.reserve(directions.size());
  for (const models::Direction& d : directions)
    parts.push_back(models::load_response(study.context.models + "/responses/" + d.response + ".toml"));
  Misfit misfit;
  misfit.weights = models::weights(directions, way_of_probe(setup.scene));
  if (study.context.mutated("unmixed")) misfit.weights = {1.0, 0.0, 0.0};
  const Response rule(models::mixed(parts, misfit.weights), 0.0, Reversal::prandtl_ishlinskii);
  const Response nearest(parts.front(), 0.0, Reversal::prandtl_ishlinskii);
  const models::LoopData loop =
      models::parse_loop(trial::table_of_run(setup, study.seed), push.name, rule.limit());
  misfit.rule = rms_of(loop.moving, rule);
  misfit.nearest = rms_of(loop.moving, nearest);
  return misfit;
}

constexpr double kSpeed = 4e-3, kPeriod = 1e-3;  // m/s as the rig's pushes, s

std::vector<double> path_of(const std::vector<double>& turns) {
  std::vector<double> path;
  double at = 0.0;
  for (const double to : turns) {
    const auto steps = std::max(1L, std::lround(std::abs(to - at) / (kSpeed * kPeriod)));
    for (long i = 1; i <= steps; ++i)
      path.push_back(at + (to - at) * static_cast<double>(i) / static_cast<double>(steps));
    at = to;
  }
  return path;
}

// The set-up with another law between the two curves.
models::Setup with_reversal(models::Setup setup, Reversal reversal) {
  for (BehaviourSpec& behaviour : setup.scene.behaviours) behaviour.reversal = reversal;
  return setup;
}

// The error of the path over the time step, for both laws between the curves.
void add_path_precision(const BenchContext& context, BenchResult& result) {
  for (const char* law : {"prandtl_ishlinskii", "energy_stop"})
    add_work_precision(
        {fmt::format("indentation.{}", law),
         "indentation",
         {fmt::format("behaviour.tennis_ball_A.reversal={}", law), "user.press_s=2", "user.release_s=2",
          "truth.hand.drift_mm=0"},  // compares the path of the machine alone
         kUnset,
         30e-6,
         false},  // courses of a press: no bound for elastic legs
        context, result);
}

}  // namespace

std::vector<Cell> add_accuracy(const IndentStudy& study, const std::vector<Cell>& standard,
                               BenchResult& result) {
  const std::vector<std::vector<IndentRun>> runs = study.all(kAccuracy, study.runs);
  const std::vector<Cell> cells = cells_of(runs, Reading::recorded);
  // N: the twin misses the cell of the paper that contradicts the paper's own MAE and bias.
  constexpr double kLeastInconsistent = 0.107, kMostInconsistent = 0.135;
  std::string words;
  for (const std::string& word : kAccuracy) words += " --set " + word;
  for (std::size_t i = 0; i < kCells; ++i) {
    const PaperCell& paper = study.paper[i];
    Figure f{fmt::format("indentation.accuracy.rmse.{}.{}", paper.indentation, paper.way),
             paper.rmse,
             cells[i].rmse,
             "N",
             paper.consistent ? Role::calibrated : Role::predicted,
             paper.consistent ? kUnset : kLeastInconsistent,
             paper.consistent ? paper.rmse : kMostInconsistent,
             "with" + words};
    f.least = cells[i].least;
    f.most = cells[i].most;
    result.figures.push_back(std::move(f));
  }
  for (const std::vector<IndentRun>& of : runs)
    for (const IndentRun& run : of) result.simulated += run.simulated;
  add_price(study, standard, cells, result);
  if (study.context.full) {
    add_trade_off(study, result);
    add_pushed(study, result);
  }
  return cells;
}

void add_energy_stop(const IndentStudy& study, Bench& bench) {
  for (std::size_t i = 0; i < indentations().size(); ++i) {
    const models::Setup setup = with_reversal(
        indent_setup(study.context.models, indentations()[i], {}, study.context.set), Reversal::energy_stop);
    const std::vector<IndentRun> runs = indent_runs(setup, study.seed, 1);
    for (const bool press : {true, false})
      bench.figure(fmt::format("energy_stop.rmse.{}.{}", indentations()[i].name, press ? "press" : "release"),
                   cell_of(runs, Reading::recorded, press).rmse, "N",
                   "the other law: its blend from one curve to the other takes 1.5 mm of travel");
    for (const IndentRun& run : runs) bench.result.simulated += run.simulated;
  }
}

void add_converged(const IndentStudy& study, BenchResult& result) {
  constexpr std::size_t kHands = 3;
  for (const Indentation& indentation : indentations()) {
    const auto runs = [&](const Words& own) {
      const std::vector<IndentRun> all = indent_runs(
          indent_setup(study.context.models, indentation, own, study.context.set), study.seed, kHands);
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
  add_path_precision(study.context, result);
}

double sensor_lag(const models::Setup& setup) {
  return recorded_lag(setup) + 1.0 / (2.0 * std::numbers::pi * setup.rig.force.filter);
}

double predicted_rmse(const LagTheory& theory, double time) {
  constexpr int kSteps = 4000;
  constexpr double kNear = 0.05e-3;  // m, as in split()
  constexpr double kWay = 1e-6;      // m, for the slope
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < kSteps; ++i) {
    const MinimumJerk at((i + 0.5) / kSteps);
    const double d = theory.depth * at.x;
    if (d >= theory.felt.limit() - kNear) break;
    const double speed = theory.depth * at.v / time;
    const double slope = (theory.felt.press(d + kWay) - theory.felt.press(std::max(0.0, d - kWay))) /
                         (kWay + std::min(d, kWay));
    const double e =
        theory.threshold + theory.lag * speed * slope + theory.felt.press(d) - theory.reference.press(d);
    sum += e * e;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : kUnset;
}

void add_press_time(const IndentStudy& study, BenchResult& result) {
  if (study.context.full) add_sweep(study, result);
  add_lag(study, result);
}

void add_directions(const IndentStudy& study, BenchResult& result) {
  const std::string path = study.context.models + "/directions/tennis_ball_any.toml";
  const std::vector<models::Direction> directions = models::load_directions(path);
  std::vector<Misfit> all(pushes().size());
  in_parallel(all.size(), [&](std::size_t i) { all[i] = misfit_of(study, pushes()[i], directions); });
  Table table{
      "indentation_directions",
      "Pushes where nothing was fitted",
      {"push", "weight of A", "weight of B", "weight of C", "RMSE of the rule (N)", "RMSE of A alone (N)"},
      {},
      "Whole loop, Prandtl-Ishlinskii law against the rig's readings. polar_165 lies beyond what was "
      "measured."};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string id = fmt::format("indentation.directions.{}", pushes()[i].name);
    result.figures.push_back(
        {id + ".rmse", kUnset, all[i].rule, "N", Role::ours, kUnset, 0.9 * all[i].nearest,
         "response mixed of A, B and C against the rig's own push there: closer than A"});
    result.figures.push_back({id + ".unmixed.rmse", kUnset, all[i].nearest, "N", Role::ours, kUnset, kUnset,
                              "A alone against the same push: what mixing is worth"});
    std::vector<std::string> row{pushes()[i].name};
    for (const double w : all[i].weights) row.push_back(fixed(w, 3));
    row.push_back(fixed(all[i].rule, 3));
    row.push_back(fixed(all[i].nearest, 3));
    table.rows.push_back(std::move(row));
  }
  result.tables.push_back(std::move(table));
}

void add_minor_loops(const IndentStudy& study, BenchResult& result) {
  const ResponseSpec ball = models::load_response(study.context.models + "/responses/tennis_ball.toml");
  const Response felt(
      ball, 0.0, study.context.mutated("other_law") ? Reversal::energy_stop : Reversal::prandtl_ishlinskii);
  Plot plot{"indentation_minor_loops", "Turning at 2 and at 4 mm", "deflection (mm)", "force (N)"};
  for (const int turn : {2, 4}) {
    sim::BallPlant plant{};
    sim::BallPlantState at{};
    ResponseState state;
    Series real{fmt::format("rig's ball, turns at {} mm", turn)};
    Series model{fmt::format("felt, turns at {} mm", turn)};
    double sum = 0.0;
    const std::vector<double> path = path_of({6e-3, turn * 1e-3, 6e-3, 0.0});
    for (std::size_t i = 0; i < path.size(); ++i) {
      const double wanted = plant.step(at, path[i], kPeriod);
      const double got = felt.force(state, path[i]);
      sum += (got - wanted) * (got - wanted);
      if (i % 20 != 0) continue;
      real.add(path[i] * 1e3, wanted);
      model.add(path[i] * 1e3, got);
    }
    result.figures.push_back({fmt::format("indentation.minor.{}.rmse", turn), kUnset,
                              std::sqrt(sum / static_cast<double>(path.size())), "N", Role::ours, kUnset, 0.1,
                              fmt::format("0-6-{}-6-0 mm at 4 mm/s: the law, fitted to 0-6-0, against the "
                                          "rig's ball; the loop of hand and machine is not in it",
                                          turn)});
    plot.series.push_back(std::move(real));
    plot.series.push_back(std::move(model));
  }
  plot.caption = "The response knows the full loop 0-6-0 alone; what it does inside is predicted.";
  result.plots.push_back(std::move(plot));
}

}  // namespace enc::bench::indentation
