// A set of devices that follows the reference curves more closely than the paper's, and what that costs: a
// higher force filter lets noise through and makes soft objects unstable.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/indentation/indentation.h"
#include "benchmarks/stiffness/push_study.h"
#include "core/machine/loop_model.h"
#include "trial/trial.h"

namespace enc::bench::indentation {
namespace {

// Half of the filter's lag, and a threshold that the quieter of two sensors would allow. The ball's softest
// slope is then below what a firm grip leaves stable: it is rendered all the same.
const Words kAccuracy{"rig.force.filter_hz=10", "rig.force.threshold_N=0.03",
                      "rig.contact.softest_N_per_mm=0"};

struct Rest {
  double tip = kUnset, force = kUnset;  // m, N: peak to peak, along the normal, of a tool held still
};

// What noise there is when a hand without tremor holds the ball at half of its depth.
Rest rest_of(const IndentStudy& study, const Words& own) {
  Words set = own;
  set.insert(set.end(), still_hand().begin(), still_hand().end());
  set.insert(set.end(), {"user.depth_mm=3", "user.press_s=2", "user.hold_s=4", "user.release_s=1"});
  const models::Setup setup =
      indent_setup(study.context.models, indentations().front(), set, study.context.set);
  constexpr double kSettled = 2.0;  // s of the hold
  std::vector<double> tip, force;
  double held = 0.0;
  trial::TrialOptions options;
  options.seed = study.seed;
  options.watch = [&](const trial::Glance& glance) {
    if (glance.truth.phase != sim::Phase::hold) return;
    held += glance.scene.dt;
    if (held < kSettled) return;
    tip.push_back(glance.truth.tip.xyz[2]);
    force.push_back(glance.out.felt.xyz[2]);
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
      "hand "
      "without "
      "tremor, force before the filter."};
  for (const auto& [name, set, cells] :
       {std::tuple{"as shipped", Words{}, &standard}, std::tuple{"set for accuracy", kAccuracy, &accurate}}) {
    const Price price = price_of(study, set);
    double worst = 0.0;
    for (std::size_t i = 0; i < kCells; ++i)
      if (study.paper[i].consistent) worst = std::max(worst, (*cells)[i].rmse / study.paper[i].rmse);
    table.rows.push_back({name, fmt::format("{:.2f}", worst), fmt::format("{:.3f}", price.grip * 1e-3),
                          fmt::format("{:.4f}", price.pusher * 1e-3),
                          fmt::format("{:.1f}", price.rest.tip * 1e6),
                          fmt::format("{:.3f}", price.rest.force)});
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

// Where one set of devices cannot serve two figures: Table 2 wants a fast filter, Fig 3 a slow one.
void add_trade_off(const IndentStudy& study, BenchResult& result) {
  const std::vector<double> corners =
      study.context.quick ? std::vector<double>{10} : std::vector<double>{2.5, 5, 10, 20, 40};
  Plot plot{"indentation_trade_off",
            "Force filter: error of a press against the softest stable object",
            "corner of the force filter (Hz)",
            "RMSE of A's press (N); stiffness (N/mm)",
            true,
            false,
            {}};
  Series recorded{"RMSE, recorded force", {}, {}, {}, {}, Mark::both};
  Series truth{"RMSE, true force", {}, {}, {}, {}, Mark::both};
  Series grip{"lowest stable, firm grip (linear)", {}, {}, {}, {}, Mark::both};
  Series pusher{"lowest stable, soft pusher (linear)", {}, {}, {}, {}, Mark::both};
  for (const double corner : corners) {
    models::Setup setup = indent_setup(study.context.models, indentations().front(), {}, study.context.set);
    setup.rig.force.filter = corner;
    setup.rig.contact.softest = 0.0;
    const std::vector<IndentRun> runs = indent_runs(setup, study.seed, study.context.quick ? 1 : 2);
    for (const auto& [series, y] :
         {std::pair{&recorded, cell_of(runs, Reading::recorded, true).rmse},
          std::pair{&truth, cell_of(runs, Reading::truth, true).rmse},
          std::pair{&grip, lowest_stable_stiffness(loop_of(setup.rig)) * 1e-3},
          std::pair{&pusher, lowest_stable_stiffness(stiffness::pushed_loop(setup)) * 1e-3}}) {
      series->x.push_back(corner);
      series->y.push_back(y);
    }
    for (const IndentRun& run : runs) result.simulated += run.simulated;
  }
  const PaperCell& paper = study.paper.front();
  plot.series = {{"paper, A press",
                  {corners.front(), corners.back()},
                  {paper.rmse, paper.rmse},
                  {},
                  {},
                  Mark::line,
                  true},
                 std::move(recorded),
                 std::move(truth),
                 std::move(grip),
                 std::move(pusher)};
  plot.caption =
      "A faster filter brings the true force nearer to the curve and makes soft objects unstable; nearer "
      "than the "
      "hand's own tremor and drift it cannot bring it. The recorded force is behind the filter, so the "
      "filter's lag is "
      "not in its error.";
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

}  // namespace

std::vector<Cell> add_accuracy(const IndentStudy& study, const std::vector<Cell>& standard,
                               BenchResult& result) {
  const std::vector<std::vector<IndentRun>> runs = study.all(kAccuracy, study.context.quick ? 1 : study.runs);
  const std::vector<Cell> cells = cells_of(runs, Reading::recorded);
  std::string words;
  for (const std::string& word : kAccuracy) words += " --set " + word;
  for (std::size_t i = 0; i < kCells; ++i) {
    const PaperCell& paper = study.paper[i];
    Figure f{fmt::format("indentation.accuracy.rmse.{}.{}", paper.indentation, paper.way),
             paper.rmse,
             cells[i].rmse,
             "N",
             paper.consistent ? Role::calibrated : Role::predicted,
             kUnset,
             paper.consistent ? paper.rmse : kUnset,
             "with" + words};
    f.least = cells[i].least;
    f.most = cells[i].most;
    result.figures.push_back(std::move(f));
  }
  for (const std::vector<IndentRun>& of : runs)
    for (const IndentRun& run : of) result.simulated += run.simulated;
  add_price(study, standard, cells, result);
  add_trade_off(study, result);
  if (study.context.full) add_pushed(study, result);
  return cells;
}

}  // namespace enc::bench::indentation
