// The files of a report, and results.json, which other programs read: keep its form (sources/choices 4).
#include <cmath>
#include <filesystem>
#include <sstream>

#include <encounter_version.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "benchmarks/report/plot.h"
#include "benchmarks/report/report.h"
#include "core/base/error.h"
#include "models/files.h"
#include "models/tables/csv_field.h"
#include "sim/bodies/mujoco.h"
#include "trial/provenance/provenance.h"

namespace enc::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
std::string word(double x) { return std::isfinite(x) ? fmt::format("{}", x) : ""; }

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) line += (i > 0 ? "," : "") + models::csv_field(cells[i]);
  return line + "\n";
}

std::string figures_csv(const BenchResult& result) {
  std::string csv = "id,paper,twin,least,most,unit,role,low,high,ok\n";
  for (const Figure& f : result.figures)
    csv += csv_line({f.id, word(f.paper), word(f.twin), word(f.least), word(f.most), f.unit,
                     role_name(f.role), word(f.low), word(f.high), f.ok() ? "1" : "0"});
  return csv;
}

Json figure_json(const Figure& f) {
  Json values = Json::array();
  for (const double x : f.values) values.push_back(number(x));
  return {{"id", f.id},
          {"paper", number(f.paper)},
          {"twin", number(f.twin)},
          {"unit", f.unit},
          {"role", role_name(f.role)},
          {"low", number(f.low)},
          {"high", number(f.high)},
          {"ok", f.ok()},
          {"misses_by", number(miss_of(f))},
          {"note", f.note},
          {"least", number(f.least)},
          {"most", number(f.most)},
          {"values", std::move(values)},
          {"cost", f.cost}};
}

Json judged_json(const FigureVerdict& j) {
  const Threshold& t = j.threshold;
  return {{"figure", j.figure.id},
          {"error", number(j.figure.twin)},
          {"unit", j.figure.unit},
          {"threshold", number(t.value)},
          {"least", number(t.least)},
          {"most", number(t.most)},
          {"over", number(j.over)},
          {"verdict", felt_name(j.felt)},
          {"paper", j.paper == Perception::not_comparable ? Json(nullptr) : Json(felt_name(j.paper))},
          {"compares", t.compares},
          {"rule", t.rule},
          {"source", t.source},
          {"confidence", t.confidence}};
}

void write_whole(const fs::path& path, const std::string& text) {
  models::write_file(path.string(), text, models::OverwritePolicy::replace);
}

}  // namespace

bool Figure::ok() const {
  if (absent) return true;
  if (!std::isfinite(twin)) return false;
  return !(std::isfinite(low) && twin < low) && !(std::isfinite(high) && twin > high);
}

double miss_of(const Figure& f) {
  const bool excluded = f.paper < f.low || f.paper > f.high;  // false for what is unset
  return excluded && !f.absent && std::isfinite(f.twin) ? f.twin - f.paper : kUnset;
}

std::string plot_csv(const Plot& plot) {
  const auto at = [](const std::vector<double>& values, std::size_t i) {
    return i < values.size() ? word(values[i]) : "";
  };
  const bool panels = !plot.panels.empty();
  std::string csv = std::string(panels ? "panel," : "") + "series,paper,x,y,low,high\n";
  for (const Series& s : plot.series)
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      std::vector<std::string> line{s.name,     s.paper ? "1" : "0", word(s.x[i]),
                                    at(s.y, i), at(s.low, i),        at(s.high, i)};
      if (panels) line.insert(line.begin(), plot.panels.at(s.panel));
      csv += csv_line(line);
    }
  return csv;
}

std::string table_csv(const Table& table) {
  std::string csv;
  std::istringstream source(table.source);
  for (std::string line; std::getline(source, line);) csv += "# " + line + "\n";
  csv += csv_line(table.columns);
  for (const auto& row : table.rows) csv += csv_line(row);
  return csv;
}

std::string results_json(const Report& report) {
  const trial::Machine machine = trial::this_machine();
  Json json;
  json["encounter"] = ENCOUNTER_VERSION;
  json["commit"] = trial::built_commit().name;
  json["commit_date"] = trial::built_commit().day;
  json["date"] = trial::day_text(report.started);
  json["started"] = trial::time_text(report.started);
  json["mujoco"] = sim::mujoco_version();
  json["machine"] = {{"processor", machine.processor},
                     {"cores", machine.cores},
                     {"system", machine.system},
                     {"compiler", machine.compiler}};
  json["seed"] = report.seed;
  json["command"] = report.command;
  json["set"] = report.set;
  json["missing"] = report.missing;
  json["benchmarks"] = Json::array();
  for (const BenchResult& result : report.results) {
    Json figures = Json::array();
    for (const Figure& f : result.figures) figures.push_back(figure_json(f));
    json["benchmarks"].push_back({{"name", result.name},
                                  {"scene", result.scene},
                                  {"run_time_s", result.run_time},
                                  {"simulated_s", result.simulated},
                                  {"note", result.note},
                                  {"figures", figures}});
  }
  json["contradictions"] = Json::array();
  for (const Contradiction& c : report.background.contradictions)
    json["contradictions"].push_back(
        {{"id", c.id}, {"where", c.where}, {"printed", c.printed}, {"found", c.found}});
  json["verdicts"] = Json::array();
  for (const FigureVerdict& j : judged(report.results, report.background.thresholds))
    json["verdicts"].push_back(judged_json(j));
  return json.dump(2) + "\n";
}

void write_report(const std::string& folder, const Report& report) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed)
    throw Error(folder + ": cannot be made (" + failed.message() + "); choose a folder that is yours");
  const fs::path at = folder;
  const auto write_plot = [&](const Plot& plot) {
    write_whole(at / (plot.id + ".plot.csv"), plot_csv(plot));
    if (const auto svg = report.drawings.find(plot.id); svg != report.drawings.end())
      write_whole(at / (plot.id + ".svg"), svg->second);
  };
  for (const BenchResult& result : report.results) {
    write_whole(at / (result.name + ".csv"), figures_csv(result));
    for (const Table& table : result.tables) write_whole(at / (table.id + ".csv"), table_csv(table));
    for (const Plot& plot : result.plots) write_plot(plot);
    for (const Picture& picture : result.pictures) write_whole(at / (picture.id + ".png"), picture.png);
  }
  if (!report.verdict.y_names.empty()) {
    const std::vector<FigureVerdict> all = judged(report.results, report.background.thresholds);
    for (const Table& table : {verdict_table(all), threshold_table(all)})
      write_whole(at / (table.id + ".csv"), table_csv(table));
    write_plot(report.verdict);
  }
  write_whole(at / "REPORT.md", report_markdown(report));
  write_whole(at / "report.html", report_html(report));
  write_whole(at / "results.json", results_json(report));  // last: the other files are then complete
}

}  // namespace enc::bench
