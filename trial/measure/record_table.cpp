#include "trial/measure/record_table.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/record/record.h"
#include "models/tables/csv_reader.h"
#include "trial/assemble/assemble.h"
#include "trial/trial.h"

namespace enc::trial {
namespace {

// Adds the shortest text that reads back to the number; an unknown number stays empty.
void add(std::string& row, double x) {
  row += ',';
  if (std::isfinite(x)) row += fmt::format("{}", x);
}

void add_empty(std::string& row, std::size_t cells) { row.append(cells, ','); }

std::string as_cell(std::string text) {
  std::erase_if(text, [](char c) { return c == ',' || c == '"' || c == '\n'; });
  return text;
}

// Description of the pressed object, as "SIMULATED ball 'nominal'". It is a table cell, so it has no comma.
std::string source_of(const models::Setup& setup) {
  if (!setup.scene.probe) return {};
  std::string text = "measured with rig '" + setup.rig.title + "'";
  if (setup.rig.force.driver == "sim") {
    const std::vector<models::Parameter> all = models::parameters(setup);
    const auto set = std::find_if(all.begin(), all.end(),
                                  [](const models::Parameter& p) { return p.name == "truth.ball.set"; });
    text = "SIMULATED and not measured: ball '" + (set == all.end() ? std::string("?") : set->value) + "'";
  }
  text += fmt::format(" pressed {:g} mm at {:g} mm/s", setup.scene.probe->depth * 1e3,
                      setup.scene.probe->speed * 1e3);
  return as_cell(std::move(text));
}

}  // namespace

double pressing_force(const Scene& scene, const Outputs& out) {
  if (scene.indentation() != nullptr)
    return dot(out.force_unfiltered, scene.indentation()->X_WN * Vec<'N'>(0, 0, 1));
  return -out.force.xyz[2];
}

std::int32_t contact_number(const Outputs& out) {
  const bool pressed = out.mode == Mode::contact || (out.mode == Mode::probe && out.deflection > 0.0);
  return pressed ? out.contacts : 0;
}

RecordTable::RecordTable(const models::Setup& setup, const Scene& scene)
    : scene_(scene), family_(family_of(scene)), source_(source_of(setup)) {
  for (const ToolSpec& tool : setup.scene.tools) tools_.push_back(as_cell(tool.name));
}

// True only in the row that received the packet: a log must not count a packet twice.
bool RecordTable::news(const Measurement<TrackedTool>& tool) {
  const bool known = tool.health == Health::ok && tool.value.tool >= 0 &&
                     tool.value.tool < static_cast<std::int32_t>(scene_.tools.size());
  if (!known || tool.t == tool_t_) return false;
  tool_t_ = tool.t;
  return true;
}

void RecordTable::add_tip(std::string& row, const Measurement<TrackedTool>& tool) const {
  const Point<'T'>& centre = scene_.tools[static_cast<std::size_t>(tool.value.tool)].tip.centre;
  for (const double x : (scene_.X_WC * (tool.value.X_CT * centre)).xyz) add(row, 1e3 * x);
  add(row, seconds(tool.t.time_since_epoch()));
}

void RecordTable::add_markers(std::string& row, const TrackedTool& tool) const {
  row += ',' + tools_[static_cast<std::size_t>(tool.tool)];
  for (const double x : tool.X_CT.xyz) add(row, 1e3 * x);
  for (const double x : tool.X_CT.xyzw) add(row, x);
}

std::string_view RecordTable::header() {
  return "time_s,mode,tip_x_mm,tip_y_mm,tip_z_mm,force_x_N,force_y_N,force_z_N,deflection_mm,force_N,repeat,"
         "tool_x_mm,tool_y_mm,tool_z_mm,tool_time_s,source,tool,markers_x_mm,markers_y_mm,markers_z_mm,"
         "markers_qx,markers_qy,markers_qz,markers_qw,tip_time_s,force_time_s,gap_mm\n";
}

std::string RecordTable::row(const Tick& tick, const Inputs& in, const Outputs& out) {
  std::string row = fmt::format("{},{}", seconds(tick.t.time_since_epoch()), mode_name(out.mode));
  const Point<'W'> tip = scene_.X_WR * family_.tip(in);
  for (const double x : tip.xyz) add(row, kMmPerM * x);
  for (const double x : out.force_unfiltered.xyz) add(row, x);
  add(row, kMmPerM * out.deflection);
  add(row, pressing_force(scene_, out));
  const std::int32_t number = contact_number(out);
  row += fmt::format(",{}", number);
  const bool seen = news(in.tool);
  seen ? add_tip(row, in.tool) : add_empty(row, 4);
  row += ',' + (number > 0 ? source_ : "");
  seen ? add_markers(row, in.tool.value) : add_empty(row, 8);
  add(row, family_.tip_stamp(in));
  add(row, stamp_of(in.wrench));
  add(row, kMmPerM * out.gap);
  return row + '\n';
}

std::string RecordTable::header_with_truth() {
  std::string names(header());
  names.pop_back();  // its newline
  return names +
         ",true_tool_x_mm,true_tool_y_mm,true_tool_z_mm,true_tip_x_mm,true_tip_y_mm,true_tip_z_mm,"
         "true_force_x_N,true_force_y_N,true_force_z_N,true_hand_x_N,true_hand_y_N,true_hand_z_N,"
         "true_touching,true_press\n";
}

std::string RecordTable::with_truth(std::string row, const sim::Truth& truth) {
  row.pop_back();  // its newline
  for (const double x : truth.tool_tip.xyz) add(row, kMmPerM * x);
  for (const double x : truth.tip.xyz) add(row, kMmPerM * x);
  for (const double x : truth.contact_force.xyz) add(row, x);
  for (const double x : truth.hand_force.xyz) add(row, x);
  return row + fmt::format(",{:d},{}\n", truth.touching, truth.press);
}

std::string table_of_run(const models::Setup& setup, std::uint64_t seed) {
  std::string text(RecordTable::header());
  const Scene scene = prepare_setup(setup);
  RecordTable table(setup, scene);
  TrialOptions options;
  options.seed = seed;
  options.watch = [&](const Glance& glance) { text += table.row(glance.tick, glance.in, glance.out); };
  Trial(setup, options).run();
  return text;
}

namespace {

// Refuses a truncated record, because half of a log gives other results. The message names the export command
// that reads it.
RecordReader whole_record(const std::string& path) {
  try {
    return RecordReader(path);
  } catch (const Error& e) {
    constexpr std::string_view kPartial = "give --partial for what is whole";
    std::string what = e.what();
    const auto advice = what.find(kPartial);
    if (advice == std::string::npos) throw;
    what.replace(advice, kPartial.size(),
                 "`encounter export RECORD --partial --csv FILE` writes what is whole as a table");
    throw Error(what, e.key());
  }
}

}  // namespace

std::string read_table(const std::string& path, const std::string& kind, const std::string& expected) {
  std::error_code none;  // a pipe is read as a table: probing it would consume its data
  if (!std::filesystem::is_regular_file(path, none) || !is_record(path))
    return models::csv_text(path, kind, expected);
  RecordReader record = whole_record(path);
  const models::Setup setup = models::setup_of(record.texts(), path);
  const Scene scene = prepare_setup(setup);
  RecordTable table(setup, scene);
  std::string text(RecordTable::header());
  RecordedTick frame;
  while (record.next(frame)) text += table.row(frame.tick, frame.in, frame.out);
  return text;
}

}  // namespace enc::trial
