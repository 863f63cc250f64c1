#include "benchmarks/report/report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/kit/benchmark.h"
#include "benchmarks/questionnaire/form.h"
#include "benchmarks/report/plot.h"
#include "sim/bodies/mujoco.h"
#include "trial/provenance/provenance.h"

namespace enc::bench {
namespace {

std::string cell(double x) { return std::isfinite(x) ? fmt::format("{:.4g}", x) : ""; }

// What was measured. Without a value, the column "holds" says whether there should have been one.
std::string twin_cell(const Figure& f) {
  if (std::isnan(f.twin)) return "absent";
  return std::isfinite(f.twin) ? cell(f.twin) : "none";
}

// "0.2 .. 0.5", "at most 0.5", "at least 0.2"
std::string range(double low, double high) {
  if (std::isfinite(low) && std::isfinite(high)) return cell(low) + " .. " + cell(high);
  if (std::isfinite(high)) return "at most " + cell(high);
  return std::isfinite(low) ? "at least " + cell(low) : "";
}

std::size_t count(const BenchResult& result, bool (*is)(const Figure&)) {
  return static_cast<std::size_t>(std::count_if(result.figures.begin(), result.figures.end(), is));
}
bool bounded(const Figure& f) { return std::isfinite(f.low) || std::isfinite(f.high); }
bool failed(const Figure& f) { return !f.ok(); }

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

void drop_empty_columns(Table& table) {
  for (std::size_t c = table.columns.size(); c-- > 0;) {
    if (std::any_of(table.rows.begin(), table.rows.end(), [&](const auto& row) { return !row[c].empty(); }))
      continue;
    const auto column = static_cast<std::ptrdiff_t>(c);
    table.columns.erase(table.columns.begin() + column);
    for (auto& row : table.rows) row.erase(row.begin() + column);
  }
}

std::string figures_line(const Report& report) {
  std::size_t figures = 0;
  std::size_t with_bounds = 0;
  std::vector<std::string> broken;
  for (const BenchResult& result : report.results) {
    figures += result.figures.size();
    with_bounds += count(result, bounded);
    for (const Figure& f : result.figures)
      if (!f.ok()) broken.push_back(f.id);
  }
  return fmt::format("{}, {} of them with bounds; {}", figures, with_bounds,
                     !broken.empty() ? fmt::format("{} out of bounds: {}", broken.size(), joined(broken))
                     : report.missing.empty() ? "all hold"
                                              : "none out of bounds so far, but not all were measured");
}

}  // namespace

const char* role_name(Role role) {
  switch (role) {
    case Role::calibrated:
      return "calibrated";
    case Role::predicted:
      return "predicted";
    case Role::ours:
      break;
  }
  return "ours";
}

std::vector<Fact> facts(const Report& report) {
  std::vector<Fact> list{
      {"Made by", trial::program_words()},   {"Started", trial::time_text(report.started)},
      {"MuJoCo", sim::mujoco_version()},     {"Machine", trial::words_of(trial::this_machine())},
      {"Seed", std::to_string(report.seed)}, {"Command", report.command},
      {"Figures", figures_line(report)}};
  const std::string felt = verdict_line(judged(report.results, report.background.thresholds));
  if (!felt.empty()) list.push_back({"Felt or not", felt});
  if (!report.set.empty()) list.push_back({"With --set", joined(report.set)});
  if (!report.not_drawn.empty()) list.push_back({"Not drawn", report.not_drawn});
  if (!report.missing.empty()) list.push_back({"Missing", joined(report.missing)});
  return list;
}

std::vector<const Plot*> ordered_plots(const Report& report) {
  std::vector<const Plot*> plots;
  for (const BenchResult& result : report.results)
    for (const Plot& plot : result.plots) plots.push_back(&plot);
  std::stable_partition(plots.begin(), plots.end(), [](const Plot* plot) {
    return std::any_of(plot->series.begin(), plot->series.end(), [](const Series& s) { return s.paper; });
  });
  return plots;
}

Table overview_table(const Report& report) {
  Table table{
      "overview",
      "What was run",
      {"benchmark", "what", "scene", "figures", "bounded", "out of bounds", "simulated (s)", "run time (s)"},
      {}};
  double run_time = 0.0;
  for (const BenchResult& r : report.results) {
    const auto all = benchmarks();
    const auto known =
        std::find_if(all.begin(), all.end(), [&](const Benchmark& b) { return r.name == b.name; });
    run_time += r.run_time;
    table.rows.push_back({r.name, known == all.end() ? "" : known->what, r.scene,
                          std::to_string(r.figures.size()), std::to_string(count(r, bounded)),
                          std::to_string(count(r, failed)), fmt::format("{:.1f}", r.simulated),
                          fmt::format("{:.2f}", r.run_time)});
  }
  for (const std::string& name : report.missing)
    table.rows.push_back({name, "missing", "", "", "", "", "", ""});
  table.note = fmt::format("{:.1f} s in all.", run_time);
  return table;
}

Table figure_table(const BenchResult& result) {
  Table table{result.name,
              "Figures of " + result.name,
              {"figure", "holds", "paper", "twin", "unit", "bounds", "difference", "difference (%)",
               "least .. most", "role", "note"},
              {}};
  for (const Figure& f : result.figures) {
    const double difference = f.twin - f.paper;
    const double percent = f.paper != 0.0 ? 100.0 * difference / std::abs(f.paper) : kUnset;
    const char* holds = f.absent ? "" : f.ok() ? "yes" : "NO";
    table.rows.push_back({f.id, holds, cell(f.paper), twin_cell(f), f.unit, range(f.low, f.high),
                          std::isfinite(difference) ? fmt::format("{:+.3g}", difference) : "",
                          std::isfinite(percent) ? fmt::format("{:+.1f}", percent) : "",
                          range(f.least, f.most), role_name(f.role), f.note});
  }
  table.note =
      fmt::format("Scene {}; {}{:.2f} s.{}", result.scene,
                  result.simulated > 0.0 ? fmt::format("{:.1f} s simulated in ", result.simulated) : "",
                  result.run_time, result.note.empty() ? "" : " " + result.note);
  drop_empty_columns(table);
  return table;
}

Table role_table(const Report& report) {
  Table table{"roles", "Calibrated and predicted", {"role", "figures", "hold", "which"}, {}};
  for (const Role role : {Role::calibrated, Role::predicted, Role::ours}) {
    std::size_t figures = 0;
    std::size_t hold = 0;
    std::vector<std::string> ids;
    for (const BenchResult& result : report.results)
      for (const Figure& f : result.figures) {
        if (f.role != role) continue;
        ++figures;
        hold += f.ok() && !f.absent ? 1 : 0;
        if (role != Role::ours) ids.push_back(f.id);
      }
    table.rows.push_back({role_name(role), std::to_string(figures), std::to_string(hold),
                          role == Role::ours ? "all others" : joined(ids)});
  }
  table.note =
      "Calibrated: the paper's value set a parameter, so that agreement is no merit. Predicted: it did not. "
      "Ours: the "
      "paper has no such value.";
  return table;
}

Table contradiction_table(const std::vector<Contradiction>& contradictions) {
  Table table{"contradictions", "Where the paper contradicts itself", {"where", "printed", "found"}, {}};
  for (const Contradiction& c : contradictions) table.rows.push_back({c.where, c.printed, c.found});
  table.note = "Computed from the printed numbers. None of these values is a target of any figure.";
  return table;
}

Background load_background(const std::string& models) {
  return {contradictions(models), load_thresholds(models),
          questionnaire::items_of(questionnaire::load_form(models, "vhmr_2020"), models)};
}

std::vector<Table> closing_tables(const Report& report) {
  const std::vector<Judged> all = judged(report.results, report.background.thresholds);
  std::vector<Table> tables{verdict_table(all), threshold_table(all),
                            questionnaire::proxy_table(report.background.items, all), role_table(report),
                            contradiction_table(report.background.contradictions)};
  std::erase_if(tables, [](const Table& t) { return t.rows.empty(); });
  for (Table& t : tables) drop_empty_columns(t);
  return tables;
}

void add_result(Report& report, BenchResult result) {
  std::erase(report.missing, result.name);
  const auto add = [&](const Plot& plot) {
    Drawing drawing = draw(plot);
    if (drawing.svg.empty())
      report.not_drawn = drawing.why_not;
    else
      report.drawings[plot.id] = std::move(drawing.svg);
  };
  for (const Plot& plot : result.plots) add(plot);
  report.results.push_back(std::move(result));
  report.verdict = verdict_plot(judged(report.results, report.background.thresholds));
  if (!report.verdict.y_names.empty()) add(report.verdict);
}

}  // namespace enc::bench
