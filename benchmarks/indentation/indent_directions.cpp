// Where nothing was fitted: presses between and beside A, B and C, and turns at 2 and 4 mm, against what the
// rig's ball does there.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "benchmarks/indentation/indentation.h"
#include "benchmarks/kit/parallel.h"
#include "core/control/task/measure/probe.h"
#include "models/directions/directions.h"
#include "models/identify/response/loop_csv.h"
#include "sim/bodies/ball_plant.h"
#include "trial/measure/record_table.h"

namespace enc::bench::indentation {
namespace {

struct Push {
  const char* name;
  Words set;
};
// Between the three, in another azimuth, and beyond them.
const std::vector<Push>& pushes() {
  static const std::vector<Push> kPushes{
      {"polar_175_offset_5", {"probe.polar_deg=175", "probe.offset_mm=5"}},
      {"offset_5", {"probe.offset_mm=5"}},
      {"azimuth_90", {"probe.azimuth_deg=90", "probe.polar_deg=173", "probe.offset_mm=-5"}},
      {"polar_165", {"probe.polar_deg=165"}}};
  return kPushes;
}

// What of the user's settings the test rig knows, too.
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
  double rule = kUnset, nearest = kUnset;  // N rms over the whole loop: mixed, and A alone
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

}  // namespace

void add_directions(const IndentStudy& study, BenchResult& result) {
  const std::string path = study.context.models + "/directions/tennis_ball_any.toml";
  const std::vector<models::Direction> directions = models::load_directions(path);
  std::vector<Misfit> all(study.context.quick ? 2 : pushes().size());
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
    result.figures.push_back({id + ".rmse", kUnset, all[i].rule, "N", Role::ours, kUnset, 0.25,
                              "response mixed of A, B and C against the rig's own push there"});
    result.figures.push_back({id + ".unmixed.rmse", kUnset, all[i].nearest, "N", Role::ours, kUnset, kUnset,
                              "A alone against the same push: what mixing is worth"});
    std::vector<std::string> row{pushes()[i].name};
    for (const double w : all[i].weights) row.push_back(fmt::format("{:.3f}", w));
    row.push_back(fmt::format("{:.3f}", all[i].rule));
    row.push_back(fmt::format("{:.3f}", all[i].nearest));
    table.rows.push_back(std::move(row));
  }
  result.tables.push_back(std::move(table));
}

void add_minor_loops(const IndentStudy& study, BenchResult& result) {
  const ResponseSpec ball = models::load_response(study.context.models + "/responses/tennis_ball.toml");
  const Response felt(ball, 0.0, Reversal::prandtl_ishlinskii);
  Plot plot{"indentation_minor_loops",
            "Turning at 2 and at 4 mm",
            "deflection (mm)",
            "force (N)",
            false,
            false,
            {}};
  for (const int turn : {2, 4}) {
    sim::BallPlant plant{};
    sim::BallPlantState at{};
    ResponseState state;
    Series real{fmt::format("rig's ball, turns at {} mm", turn), {}, {}};
    Series model{fmt::format("felt, turns at {} mm", turn), {}, {}};
    double sum = 0.0;
    const std::vector<double> path = path_of({6e-3, turn * 1e-3, 6e-3, 0.0});
    for (std::size_t i = 0; i < path.size(); ++i) {
      const double wanted = plant.step(at, path[i], kPeriod);
      const double got = felt.force(state, path[i]);
      sum += (got - wanted) * (got - wanted);
      if (i % 20 != 0) continue;
      real.x.push_back(path[i] * 1e3);
      real.y.push_back(wanted);
      model.x.push_back(path[i] * 1e3);
      model.y.push_back(got);
    }
    result.figures.push_back(
        {fmt::format("indentation.minor.{}.rmse", turn), kUnset,
         std::sqrt(sum / static_cast<double>(path.size())), "N", Role::ours, kUnset, 0.1,
         fmt::format("0-6-{}-6-0 mm at 4 mm/s: the law, fitted to 0-6-0, against the rig's ball; "
                     "the loop of hand and machine is not in it",
                     turn)});
    plot.series.push_back(std::move(real));
    plot.series.push_back(std::move(model));
  }
  plot.caption = "The response knows the full loop 0-6-0 alone; what it does inside is predicted.";
  result.plots.push_back(std::move(plot));
}

}  // namespace enc::bench::indentation
