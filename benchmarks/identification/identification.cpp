// Does `encounter fit --ball` find the ball, and does it know how well? A hundred balls whose numbers the fit
// does not know are pressed by the rig; then the same with what the fit is wrong about.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/identification/identification_trial.h"
#include "benchmarks/kit/force_precision.h"
#include "benchmarks/kit/kit.h"

namespace enc::bench::identification {
namespace {

// The first is what must hold; the others say what it rests on.
const std::array<IdentificationCase, 6>& cases() {
  static const std::array<IdentificationCase, 6> kCases{{
      {"injected", "as recommended (rig_identify)", "rig_identify"},
      {"misplaced", "ball 0.1 mm nearer", "rig_identify", {"truth.ball.misplaced_mm=[0,0,-0.1]"}},
      {"misplaced_held",
       "ball 0.1 mm nearer, taken to be in place",
       "rig_identify",
       {"truth.ball.misplaced_mm=[0,0,-0.1]"},
       false,
       false,
       true},
      {"wall_wrong", "wall 3.3 to 3.7 mm, taken for 3.5 mm", "rig_identify", {}, true},
      {"wall_found", "wall 3.3 to 3.7 mm, found as well", "rig_identify", {}, true, true},
      {"slow", "at 4 mm/s without a dwell (rig_A)", "rig_A"},
  }};
  return kCases;
}

using Trials = std::vector<IdentificationTrial>;
struct Run {
  std::size_t which = 0;  // of cases()
  std::uint64_t seed = 0;
};

// Counts over trials of one number.
struct Tally {
  std::size_t inside = 0, trials = 0;
  std::vector<double> widths;  // of the value
  [[nodiscard]] double inside_percent() const {
    return 100.0 * static_cast<double>(inside) / static_cast<double>(trials);
  }
};
Tally tally(const Trials& trials, std::size_t number) {
  Tally t;
  for (const IdentificationTrial& trial : trials)
    for (const trial::BallEstimate& e : trial.fit.estimates) {
      if (e.number != number) continue;
      ++t.trials;
      t.inside += trial.holds(e) ? 1 : 0;
      t.widths.push_back(e.width());
    }
  return t;
}
// Over all numbers of the ball's law that every loop tells.
double inside_percent(const Trials& trials) {
  double sum = 0.0;
  for (std::size_t i = 0; i < trial::kNearer; ++i) sum += tally(trials, i).inside_percent();
  return sum / static_cast<double>(trial::kNearer);
}

// "rubber_modulus" of "rubber_modulus_MPa".
std::string bare(std::size_t number) {
  const std::string_view name = trial::ball_numbers()[number].name;
  const std::size_t unit = name.find_last_of('_');
  const bool has_unit = trial::ball_numbers()[number].unit != 1.0 || name.ends_with("_s");
  return std::string(has_unit ? name.substr(0, unit) : name);
}

std::array<Trials, 6> run_all(const BenchContext& context) {
  const std::size_t most = context.quick         ? 4
                           : context.repeats > 0 ? static_cast<std::size_t>(context.repeats)
                                                 : 100;
  const std::size_t others = context.quick ? 1 : context.full ? most : std::min<std::size_t>(most, 8);
  std::vector<Run> runs;
  std::array<Trials, 6> all;
  for (std::size_t c = 0; c < all.size(); ++c) {
    all[c].resize(c == 0 ? most : others);
    for (std::size_t i = 0; i < all[c].size(); ++i) runs.push_back({c, context.seed + i});
  }
  in_parallel(
      runs.size(),
      [&](std::size_t i) {
        const Run& run = runs[i];
        all[run.which][run.seed - context.seed] = identify_once(context, cases()[run.which], run.seed);
      },
      context.progress);
  return all;
}

void add_figures(BenchResult& result, const std::array<Trials, 6>& all) {
  const auto add = [&](const std::string& id, double twin, const char* unit, double low, double high,
                       std::string note) {
    result.figures.push_back(
        {"identification." + id, kUnset, twin, unit, Role::ours, low, high, std::move(note)});
  };
  const std::size_t trials = all[0].size();
  // Of fewer, a share says nothing.
  const double least = trials >= 50 ? 90.0 : kUnset;
  for (std::size_t i = 0; i <= trial::kNearer; ++i) {
    const Tally t = tally(all[0], i);
    add(bare(i) + ".inside_percent", t.inside_percent(), "%", least, kUnset,
        fmt::format("injected value in the 95 % interval, {} trials", trials));
    // A hundredth of nearer's size, 0.1 mm, is 1 um.
    const bool place = i == trial::kNearer;
    add(bare(i) + (place ? ".width_um.median" : ".width_percent.median"), 100.0 * median(t.widths),
        place ? "um" : "%", kUnset, place ? kUnset : 20.0,
        place ? "full width of the interval of where the ball stands"
              : "full width of the interval over the value");
    Figure& width = result.figures.back();
    width.least = 100.0 * percentile(t.widths, 0.0);
    width.most = 100.0 * percentile(t.widths, 1.0);
  }
  for (std::size_t c = 1; c < all.size(); ++c)
    add(std::string(cases()[c].id) + ".inside_percent", inside_percent(all[c]), "%", kUnset, kUnset,
        fmt::format("{}: of the eight numbers, {} trials", cases()[c].what, all[c].size()));
}

Table case_table(const std::array<Trials, 6>& all) {
  Table table{
      "identification_cases",
      "Injected value inside of the 95 % interval, of all trials; median of its full width over the value",
      {"case", "trials"},
      {}};
  for (std::size_t i = 0; i < trial::kNearer; ++i) table.columns.push_back(bare(i));
  for (std::size_t c = 0; c < all.size(); ++c) {
    std::vector<std::string> row{cases()[c].what, fmt::format("{}", all[c].size())};
    for (std::size_t i = 0; i < trial::kNearer; ++i) {
      const Tally t = tally(all[c], i);
      row.push_back(fmt::format("{}; {:.1f} %", t.inside, 100.0 * median(t.widths)));
    }
    table.rows.push_back(std::move(row));
  }
  table.note =
      "A ball that stands elsewhere along the push is found with the rest and does no harm; taken to be in "
      "place, "
      "the felt answers for it. A wall that is not as thick as said moves the modulus far out of its "
      "interval, "
      "which knows of noise only. Widths are those of noise: the law itself is within 1.1 % rms of a solver "
      "(sources/ball 4), and no real ball is the law.";
  return table;
}

Plot recovered_plot(const Trials& trials) {
  Plot plot{"identification_recovered",
            "Injected and recovered numbers of the ball, over those of the nominal ball",
            "injected / nominal",
            "recovered / nominal",
            false,
            false,
            {},
            "Bars: 95 % intervals. Each ball has all eight numbers drawn at once, and the fit begins at 1."};
  for (std::size_t i = 0; i < trial::kNearer; ++i) {
    const double nominal = trial::value_of(trial::ball_numbers()[i], {});
    Series series{bare(i), {}, {}, {}, {}, Mark::bars};
    for (const IdentificationTrial& trial : trials) {
      const models::Interval& found = trial.fit.estimates[i].interval;
      series.x.push_back(trial::value_of(trial::ball_numbers()[i], trial.truth) / nominal);
      series.y.push_back(found.value / nominal);
      series.low.push_back((found.value - found.half) / nominal);
      series.high.push_back((found.value + found.half) / nominal);
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

Plot error_plot(const Trials& trials) {
  Plot plot{
      "identification_inside",
      "Error of each number over half of its interval's width",
      "number",
      "recovered less injected, over the half width (-)",
      false,
      false,
      {},
      "Inside of -1 to 1 the interval holds the injected value: about 95 of 100 of each number should be."};
  Series band{"interval", {-0.5, static_cast<double>(trial::kNearer) + 0.5},
              {0.0, 0.0}, {-1.0, -1.0},
              {1.0, 1.0}, Mark::band};
  Series points{"trials", {}, {}, {}, {}, Mark::points};
  for (std::size_t i = 0; i <= trial::kNearer; ++i) {
    plot.x_names.push_back(bare(i));
    for (std::size_t n = 0; n < trials.size(); ++n) {
      const models::Interval& found = trials[n].fit.estimates[i].interval;
      points.x.push_back(static_cast<double>(i) +
                         0.7 * (static_cast<double>(n) / static_cast<double>(trials.size()) - 0.5));
      points.y.push_back((found.value - trial::value_of(trial::ball_numbers()[i], trials[n].truth)) /
                         found.half);
    }
  }
  plot.series = {band, points};
  return plot;
}

Plot width_plot(const std::array<Trials, 6>& all) {
  Plot plot{
      "identification_widths",
      "Full width of the 95 % intervals",
      "number",
      "width over the value (%)",
      false,
      true,
      {},
      "Median, least and most. What is asked: 20 %. The programme of the paper's rig is too slow for the "
      "fastest branch; a wall to be found as well costs the modulus a factor, and little else."};
  for (const std::size_t c : {0U, 4U, 5U}) {
    Series series{cases()[c].what, {}, {}, {}, {}, Mark::bars};
    for (std::size_t i = 0; i < trial::kNearer; ++i) {
      const Tally t = tally(all[c], i);
      series.x.push_back(static_cast<double>(i) + 0.15 * static_cast<double>(plot.series.size()));
      series.y.push_back(100.0 * median(t.widths));
      series.low.push_back(100.0 * percentile(t.widths, 0.0));
      series.high.push_back(100.0 * percentile(t.widths, 1.0));
    }
    plot.series.push_back(std::move(series));
  }
  for (std::size_t i = 0; i < trial::kNearer; ++i) plot.x_names.push_back(bare(i));
  plot.series.push_back({"asked", {-0.5, static_cast<double>(trial::kNearer) - 0.5}, {20.0, 20.0}});
  return plot;
}

}  // namespace

void run(Bench& bench) {
  const BenchContext& context = bench.context;
  BenchResult& result = bench.result;
  const std::array<Trials, 6> all = run_all(context);
  for (const Trials& trials : all)
    for (const IdentificationTrial& trial : trials) result.simulated += trial.simulated;
  add_figures(result, all);
  result.tables.push_back(case_table(all));
  result.plots = {recovered_plot(all[0]), error_plot(all[0]), width_plot(all)};
  result.note =
      "The fit knows the ball's law and the thickness of felt and wall; it does not know the eight numbers, "
      "where "
      "the ball stands, the force sensor's noise or its zero.";
  add_force_precision(bench);
}

const Entry kEntry{
    "identification", "rig_identify",
    "injected ball parameters out of a rig's loops: are they in the intervals, how wide are these", run};

}  // namespace enc::bench::identification
