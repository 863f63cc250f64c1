#include "app/sweep/results.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text_output.h"
#include "core/base/error.h"
#include "models/tables/csv_field.h"
#include "trial/provenance/provenance.h"

namespace enc::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using models::csv_field;

std::string csv_head(const trial::SweepSpec& spec) {
  std::string text = "id,point,seed";
  for (const trial::Axis& axis : spec.axes) text += "," + csv_field(axis.name);
  for (const std::string& name : spec.keep) text += "," + csv_field(name);
  return text + ",exit,state_hash,error\n";
}

std::string file_in(const std::string& folder, const char* name) {
  return (fs::path(folder) / name).string();
}

class Writer {
 public:
  Writer(const std::string& folder, SweepTable& table)
      : table_(table),
        design_(table.spec),
        lines_(file_in(folder, "results.ndjson"), models::OverwritePolicy::replace),
        csv_(file_in(folder, "results.csv"), models::OverwritePolicy::replace),
        cost_(file_in(folder, "cost.csv"), models::OverwritePolicy::replace) {
    csv_.write(csv_head(table.spec));
    cost_.write("id,cpu_s\n");
  }

  void add(const trial::ResultLine& line) {
    const std::string text = std::string(line.results) + "}";
    lines_.write(text + "\n");
    cost_.write(fmt::format("{},{}\n", line.id, line.cpu));
    const Json json = Json::parse(text);
    const std::int64_t point = line.id / table_.spec.seeds;
    if (point != point_) values_ = design_.values(point);
    point_ = point;
    std::string row = fmt::format("{},{},{}", line.id, point, json.at("seed").get<std::uint64_t>());
    for (std::size_t i = 0; i < values_.size(); ++i) {
      table_.parameters[i].push_back(values_[i]);
      row += "," + csv_field(values_[i]);
    }
    for (std::size_t i = 0; i < table_.spec.keep.size(); ++i) {
      const Json& figures = json.at("figures");
      const Json value = figures.is_object() ? figures.at(table_.spec.keep[i]) : Json();
      table_.figures[i].push_back(value.is_number() ? value.get<double>() : kUnset);
      row += "," + (value.is_number() ? value.dump() : std::string());
    }
    const std::string error = json.value("error", "");
    if (trial::failed(line.exit))
      table_.errors.push_back(fmt::format("run {}: {}", line.id, error.empty() ? "ended in hold" : error));
    table_.exits.push_back(line.exit);
    table_.cpu.push_back(line.cpu);
    const Json& hash = json.at("state_hash");
    csv_.write(fmt::format("{},{},{},{}\n", row, line.exit, hash.is_string() ? hash.get<std::string>() : "",
                           csv_field(error)));
  }
  void keep() {
    lines_.end();
    csv_.end();
    cost_.end();
  }

 private:
  SweepTable& table_;
  trial::Design design_;
  TextOutput lines_, csv_, cost_;
  std::int64_t point_ = -1;
  std::vector<std::string> values_;
};

}  // namespace

std::int64_t SweepTable::failures() const {
  return std::count_if(exits.begin(), exits.end(), [](int exit) { return trial::failed(exit); });
}
std::int64_t SweepTable::crossed() const { return std::count(exits.begin(), exits.end(), 1); }

SweepTable write_results(const std::string& folder, const trial::SweepSpec& spec,
                         const trial::SweepIdentity& identity) {
  const trial::MergedLines lines(folder, identity);
  SweepTable table{spec, trial::program_words(), {}, {}, {}, {}, {}};
  table.parameters.resize(spec.axes.size());
  table.figures.resize(spec.keep.size());
  Writer writer(folder, table);
  for (std::int64_t run = 0; run < lines.size(); ++run) writer.add(lines.at(run));
  writer.keep();
  models::write_file(file_in(folder, "report.html"), sweep_page(table), models::OverwritePolicy::replace);
  return table;
}

}  // namespace enc::app
