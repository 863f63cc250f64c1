#include "benchmarks/tracking/table1.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "benchmarks/kit/kit.h"
#include "core/base/units.h"

namespace enc::bench::tracking {
namespace {

Column column_of(const std::array<ErrorSum, 3>& axes) {
  Column column{};
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const Errors e = axes[a].errors();
    column[a] = {e.rmse, e.mae};
  }
  fill_norm(column);
  return column;
}

}  // namespace

void TravelErrors::add(const TravelErrors& other) {
  TravelSums::add(other);
  simulated += other.simulated;
  if (held.empty()) held = other.held;
}

TravelErrors run_travel(const models::Setup& setup, std::uint64_t seed, bool keep_packets,
                        const trial::TrialOptions& base) {
  trial::TravelMeasure measure(keep_packets);
  trial::TrialOptions options = base;
  options.seed = seed;
  options.watch = [&](const trial::Glance& glance) { measure.see(glance); };
  trial::Trial trial(setup, options);
  while (trial.tick()) {
  }
  check_ended(trial);
  TravelErrors errors{measure.sums()};
  errors.held = held_in(trial);
  errors.simulated = static_cast<double>(trial.result().ticks) * trial.scene().dt;
  return errors;
}

Table1 table1_of(const Reference& reference) {
  Table1 table{};
  for (std::size_t s = 0; s < kTableSpeeds.size(); ++s)
    for (std::size_t a = 0; a < kTableAxes.size(); ++a) {
      const std::string speed = std::to_string(kTableSpeeds[s]);
      const std::size_t row = reference.row({{"speed_mm_s", speed}, {"axis", kTableAxes[a]}});
      table[s][a] = {reference.number(row, "rmse_mm") * 1e-3, reference.number(row, "mae_mm") * 1e-3};
    }
  return table;
}

void fill_norm(Column& column) {
  column[3] = {std::hypot(column[0].rmse, column[1].rmse, column[2].rmse),
               std::hypot(column[0].mae, column[1].mae, column[2].mae)};
}

Column resting_column(const TravelErrors& errors) { return column_of(errors.stopped); }

Column moving_column(const TravelErrors& errors, BiasSide side) {
  std::array<ErrorSum, 3> axes;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (side != BiasSide::adds) axes[a].add(errors.forward[a]);
    if (side != BiasSide::opposes) axes[a].add(errors.back[a]);
  }
  return column_of(axes);
}

Table1 table_of(const TravelErrors& slow, const TravelErrors& fast, BiasSide side) {
  TravelErrors both = slow;
  both.add(fast);
  return {resting_column(both), moving_column(slow, side), moving_column(fast, side)};
}

TravelErrors Group::all() const {
  TravelErrors sum;
  for (const TravelErrors& one : seeds) sum.add(one);
  return sum;
}

// Stops are just long enough to separate them from moves; under --full they are as long as the paper's.
Group travels_at(const BenchContext& context, int speed, const char* ways,
                 const std::vector<std::string>& more, std::size_t seeds) {
  Group group;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<std::string> set{fmt::format("travel.axes=\"{}\"", kTableAxes[axis]),
                                 fmt::format("travel.speed_mm_s={}", speed),
                                 fmt::format("travel.ways=\"{}\"", ways),
                                 fmt::format("travel.dwell_s={}", context.full ? "5" : "0.6")};
    set.insert(set.end(), more.begin(), more.end());
    group.setup[axis] = load_scene(context, "tracking", set);
  }
  group.seeds.resize(seeds);
  return group;
}

void run_all(const std::vector<Group*>& groups, const BenchContext& context, double& simulated) {
  struct Job {
    Group* group;
    std::size_t seed, axis;
    TravelErrors errors;
  };
  std::vector<Job> jobs;
  for (Group* group : groups)
    for (std::size_t seed = 0; seed < group->seeds.size(); ++seed)
      for (std::size_t axis = 0; axis < 3; ++axis) jobs.push_back({group, seed, axis, {}});
  const auto work = [&](std::size_t i) {
    Job& job = jobs[i];
    // Every axis has its own phase of tracker and server, like successive experiments.
    job.errors =
        run_travel(job.group->setup[job.axis], context.seed * 1000 + 3 * job.seed + job.axis, job.seed == 0);
  };
  in_parallel(jobs.size(), work, context.progress);
  for (const Job& job : jobs) {
    job.group->seeds[job.seed].add(job.errors);
    simulated += job.errors.simulated;
  }
}

SpannedTable twin_table(const Group& slow, const Group& fast, BiasSide side) {
  SpannedTable twin{table_of(slow.all(), fast.all(), side), {}, {}};
  twin.least = twin.most = twin.table;
  for (std::size_t i = 0; i < slow.seeds.size(); ++i) {
    const Table1 one = table_of(slow.seeds[i], fast.seeds[i], side);
    twin.seeds.push_back(one);
    for (std::size_t s = 0; s < one.size(); ++s)
      for (std::size_t a = 0; a < one[s].size(); ++a)
        for (const Statistic& statistic : kStatistics) {
          const auto what = statistic.what;
          twin.least[s][a].*what = std::min(twin.least[s][a].*what, one[s][a].*what);
          twin.most[s][a].*what = std::max(twin.most[s][a].*what, one[s][a].*what);
        }
  }
  return twin;
}

// One delay for all axes cannot have these within 10 %: x's lag is 14 % longer than z's
// (docs/notes/tracking.md).
bool apart(const Statistic& statistic, std::size_t s, std::size_t a) {
  const bool rmse = statistic.what == &Cell::rmse;
  return (a == 2 && s > 0 && rmse) || (a == 0 && s == 2 && !rmse);
}

// Bounds: 10 %, of three cells 12.5 %; 6 % (norms).
void add_table_figures(BenchResult& result, const Table1& paper, const SpannedTable& twin,
                       const Table1& theory) {
  const auto add = [&](const Statistic& statistic, std::size_t s, std::size_t a) {
    const auto what = statistic.what;
    const double share = a == 3 ? 0.06 : apart(statistic, s, a) ? 0.125 : 0.1;
    const double value = paper[s][a].*what * 1e3;
    Figure f{fmt::format("tracking.{}.{}.{}", statistic.id, kTableAxes[a], kTableSpeeds[s]),
             value,
             twin.table[s][a].*what * 1e3,
             "mm",
             Role::calibrated,
             (1.0 - share) * value,
             (1.0 + share) * value,
             fmt::format("theory {:.4f} mm", theory[s][a].*what * 1e3)};
    if (s == 0 && a == 3 && what == &Cell::mae) {
      f.low = f.high = kUnset;
      f.note += fmt::format("; no target: the paper's norm does not follow from its components, {:.4f} mm",
                            1e3 * std::hypot(paper[0][0].mae, paper[0][1].mae, paper[0][2].mae));
    }
    f.least = twin.least[s][a].*what * 1e3;
    f.most = twin.most[s][a].*what * 1e3;
    for (const Table1& one : twin.seeds) f.values.push_back(one[s][a].*what * 1e3);
    result.figures.push_back(std::move(f));
  };
  for (std::size_t s = 0; s < paper.size(); ++s)
    for (std::size_t a = 0; a < kTableAxes.size(); ++a)
      for (const Statistic& statistic : kStatistics) add(statistic, s, a);
}

std::string fine_mm(double metres) { return fixed(metres * kMmPerM, 4); }
std::string percent(double ratio) { return fmt::format("{:+.1f}", (ratio - 1.0) * 100.0); }

Table table1_table(const Table1& paper, const SpannedTable& twin, const Table1& theory) {
  Table table{"tracking_table1",
              "Table 1: calibrated on all columns",
              {"speed (mm/s)", "axis", "statistic", "paper (mm)", "twin (mm)", "difference (%)", "least (mm)",
               "most (mm)", "theory (mm)"}};
  for (std::size_t s = 0; s < paper.size(); ++s)
    for (std::size_t a = 0; a < kTableAxes.size(); ++a)
      for (const auto& [name, id, what] : kStatistics)
        table.add(kTableSpeeds[s], kTableAxes[a], name, fine_mm(paper[s][a].*what),
                  fine_mm(twin.table[s][a].*what), percent(twin.table[s][a].*what / paper[s][a].*what),
                  fine_mm(twin.least[s][a].*what), fine_mm(twin.most[s][a].*what),
                  fine_mm(theory[s][a].*what));
  table.note = "Least and most: over seeds, which are the phases of the tracker's and the server's clocks.";
  return table;
}

Plot table1_plot(const Statistic& statistic, const Table1& paper, const SpannedTable& twin,
                 const SpannedTable& predicted) {
  Plot plot{.id = fmt::format("tracking_{}", statistic.id),
            .title = fmt::format("Table 1, {}", statistic.name),
            .x_label = "axis and speed, mm/s",
            .y_label = fmt::format("{} (mm)", statistic.name)};
  Series printed{.name = "paper", .mark = Mark::points, .paper = true};
  Series measured{.name = "twin, calibrated on all columns", .mark = Mark::bars};
  Series foreseen{.name = "from columns 0 and 20: median, 90 %", .mark = Mark::bars};
  for (std::size_t s = 0; s < paper.size(); ++s)
    for (std::size_t a = 0; a < kTableAxes.size(); ++a) {
      const double x = static_cast<double>(4 * s + a);
      const auto span = [&](const SpannedTable& of) {
        const auto what = statistic.what;
        return Value(of.table[s][a].*what * kMmPerM, of.least[s][a].*what * kMmPerM,
                     of.most[s][a].*what * kMmPerM);
      };
      plot.x_names.push_back(fmt::format("{} {}", kTableAxes[a], kTableSpeeds[s]));
      printed.add(x, paper[s][a].*statistic.what * kMmPerM);
      measured.add(x, span(twin));
      if (s == 2) foreseen.add(x, span(predicted));
    }
  plot.series = {measured, foreseen, printed};
  plot.caption =
      "Blue: the twin, its interval spans the seeds. Orange is a prediction: nothing at 40 mm/s was used for "
      "it; the interval holds 90 % of what the other columns leave open.";
  return plot;
}

}  // namespace enc::bench::tracking
