#include "app/sweep/results.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "models/files.h"
#include "trial/provenance/provenance.h"

namespace enc::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Quotes a field where RFC 4180 requires it.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string csv_head(const trial::SweepSpec& spec) {
  std::string text = "id,point,seed";
  for (const trial::Axis& axis : spec.axes) text += "," + field(axis.name);
  for (const std::string& name : spec.keep) text += "," + field(name);
  return text + ",exit,state_hash,error\n";
}

// Writes in pieces: the text of 10^6 runs is not held in memory.
class ResultFile {
 public:
  ResultFile(const std::string& folder, const char* name)
      : file_((fs::path(folder) / name).string(), models::OverwritePolicy::replace) {}
  void add(std::string_view text) {
    text_ += text;
    if (text_.size() > kPiece) flush();
  }
  void keep() {
    flush();
    file_.keep();
  }

 private:
  static constexpr std::size_t kPiece = 1U << 20U;  // bytes
  void flush() {
    file_.write(text_);
    text_.clear();
  }
  models::OutFile file_;
  std::string text_;
};

class Writer {
 public:
  Writer(const std::string& folder, SweepTable& table)
      : table_(table),
        design_(table.spec),
        lines_(folder, "results.ndjson"),
        csv_(folder, "results.csv"),
        cost_(folder, "cost.csv") {
    csv_.add(csv_head(table.spec));
    cost_.add("id,cpu_s\n");
  }

  void add(const trial::ResultLine& line) {
    const std::string text = std::string(line.results) + "}";
    lines_.add(text + "\n");
    cost_.add(fmt::format("{},{}\n", line.id, line.cpu));
    const Json json = Json::parse(text);
    const std::int64_t point = line.id / table_.spec.seeds;
    if (point != point_) values_ = design_.values(point);
    point_ = point;
    std::string row = fmt::format("{},{},{}", line.id, point, json.at("seed").get<std::uint64_t>());
    for (std::size_t i = 0; i < values_.size(); ++i) {
      table_.parameters[i].push_back(values_[i]);
      row += "," + field(values_[i]);
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
    csv_.add(fmt::format("{},{},{},{}\n", row, line.exit, hash.is_string() ? hash.get<std::string>() : "",
                         field(error)));
  }
  void keep() {
    lines_.keep();
    csv_.keep();
    cost_.keep();
  }

 private:
  SweepTable& table_;
  trial::Design design_;
  ResultFile lines_, csv_, cost_;
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
  models::write_file((fs::path(folder) / "report.html").string(), sweep_page(table),
                     models::OverwritePolicy::replace);
  return table;
}

}  // namespace enc::app
