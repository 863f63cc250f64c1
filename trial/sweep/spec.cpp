#include "trial/sweep/spec.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/record/state_hash.h"
#include "models/files.h"
#include "models/schema/schema_walk.h"
#include "models/schema/wording.h"
#include "trial/sweep/design.h"

namespace enc::trial {
namespace {

namespace fs = std::filesystem;
using models::Key;
using models::Presence;
using models::Visitor;

constexpr std::size_t kLongest = 1U << 20U;  // bytes: a longer file is no spec

Key key(std::string_view name, std::string_view meaning, Presence presence = Presence::defaulted,
        models::Range range = models::kAny) {
  return {name, meaning, "sweep", models::Confidence::chosen, range, presence, {}, true};
}

struct AxisTable {
  Axis axis;
  std::string name, words;
  std::vector<double> values;
};

struct SpecTables {
  std::int64_t format = 1;
  std::string keep;
  std::vector<AxisTable> vary;
};

constexpr models::Range kCount{1.0, 1e9, false, true};

void describe(Visitor& v, AxisTable& a) {
  v.value(key("name", "a name of `encounter params SCENE`", Presence::needed), &a.name);
  v.value(key("values", "values in the unit of the name"), &a.values);
  v.value(key("words", "values that are no numbers, separated by blanks"), &a.words);
  v.value(key("from", "one end of a range"), &a.axis.from);
  v.value(key("to", "the other end of a range"), &a.axis.to);
  v.value(key("steps", "grid only: number of values of the range", Presence::defaulted, kCount),
          &a.axis.steps);
  models::choice(v, key("scale", "linear, or log: equal ratios are equally far apart"), a.axis.scale);
}

void describe(Visitor& v, SweepSpec& s, SpecTables& t) {
  v.value(key("format", "version of this file's format", Presence::needed, {1.0, 1.0}), &t.format);
  v.value(key("scene", "name of a shipped scene, or a file beside this one", Presence::needed), &s.scene);
  v.value(key("rig", "rig, as for run"), &s.rig);
  models::choice(v, key("design", "grid: all combinations; random; sobol: evenly spread points"), s.design);
  v.value(key("points", "random, sobol: number of points", Presence::defaulted, kCount), &s.points);
  v.value(key("seeds", "runs of each point", Presence::defaulted, kCount), &s.seeds);
  v.value(key("for_s", "length of each run", Presence::optional, models::kPositive), &s.seconds);
  v.value(key("keep", "measures to keep, separated by blanks", Presence::needed), &t.keep);
  models::list(v, "vary", t.vary, [&](AxisTable& a) { describe(v, a); });
}

std::vector<std::string> split(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

bool has(const SweepSpec& spec, const std::string& of, const char* which) {
  return spec.places.contains(fmt::format("vary.{}.{}", of, which));
}

[[noreturn]] void refuse(const SweepSpec& spec, const std::string& where, const std::string& what) {
  throw Error(place_in(spec, where) + ": " + what);
}

// An axis has either values, words or a range.
void fill_levels(const SweepSpec& spec, AxisTable& table) {
  const std::string at = "vary." + table.name;
  Axis& axis = table.axis;
  axis.name = table.name;
  axis.levels = split(table.words);
  for (const double value : table.values) axis.levels.push_back(fmt::format("{}", value));
  const bool range = has(spec, table.name, "from") && has(spec, table.name, "to");
  const bool part = has(spec, table.name, "from") || has(spec, table.name, "to");
  const bool values = has(spec, table.name, "values"), listed = has(spec, table.name, "words");
  if (static_cast<int>(values) + static_cast<int>(listed) + static_cast<int>(part) != 1 || part != range)
    refuse(spec, at,
           "expected one of 'values', 'words', or 'from' and 'to'; write it like 'values = [25, 30, 35]'");
  if (listed && axis.levels.empty())
    refuse(spec, at + ".words", "'words' has no word; expected one or more; leave the table out");
  const bool grid = spec.design == DesignKind::grid;
  if (range && grid && axis.steps < 2)
    refuse(spec, at, "a range of a grid needs its number of values; add 'steps = 5', or 2 and more");
  if (axis.steps != 0 && (!range || !grid))
    refuse(spec, at + ".steps", "'steps' is for a range of a grid; leave it out");
  if (range && !(axis.from < axis.to))
    refuse(spec, at + ".to", fmt::format("'to' is {}; expected more than 'from', {}", axis.to, axis.from));
  if (axis.scale == AxisScale::log && !(range && axis.from > 0.0))
    refuse(spec, at + ".scale", "'log' needs a range above 0; leave it out");
}

void count_points(SweepSpec& spec) {
  const bool grid = spec.design == DesignKind::grid;
  if (grid && spec.places.contains("points"))
    refuse(spec, "points", "'points' is for random and sobol; a grid has all combinations; leave it out");
  if (!grid && spec.axes.empty())
    refuse(spec, "design", "the design is empty: nothing varies; expected [[vary]]; add one");
  if (!grid && spec.points == 0)
    refuse(spec, "design", "the design is empty: 'points' is missing; add 'points = 100'");
  if (grid && spec.axes.empty() && spec.seeds == 1)
    refuse(spec, "design",
           "the design is empty: nothing varies; expected [[vary]], or more than one of 'seeds'; add one");
  if (spec.design == DesignKind::sobol && spec.axes.size() > kMostSobolAxes)
    refuse(spec, "design",
           fmt::format("{} parameters vary; expected at most {} in a Sobol design; use random",
                       spec.axes.size(), kMostSobolAxes));
  double points = grid ? 1.0 : static_cast<double>(spec.points);
  for (const Axis& axis : spec.axes)
    if (grid) points *= static_cast<double>(axis.levels.size()) + static_cast<double>(axis.steps);
  const double runs = points * static_cast<double>(spec.seeds);
  if (runs > static_cast<double>(kMostRuns))
    refuse(spec, grid ? "design" : "points",
           fmt::format("the design has {:.6g} runs; expected at most {}; take fewer points, values or seeds",
                       runs, kMostRuns));
  spec.points = static_cast<std::int64_t>(points);
}

// A scene beside the spec comes before a shipped one.
std::string scene_path(const SweepSpec& spec) {
  const fs::path beside = fs::path(spec.path).parent_path() / spec.scene;
  std::error_code none;
  return fs::is_regular_file(beside, none) ? beside.string() : spec.scene;
}

}  // namespace

std::string Axis::at(double share) const {
  if (!levels.empty()) {
    const auto i = static_cast<std::size_t>(share * static_cast<double>(levels.size()));
    return levels[std::min(i, levels.size() - 1)];
  }
  if (scale == AxisScale::linear) return fmt::format("{}", from + share * (to - from));
  // The ends are exact.
  return fmt::format("{}", share <= 0.0   ? from
                           : share >= 1.0 ? to
                                          : std::exp(std::log(from) + share * std::log(to / from)));
}

std::string place_in(const SweepSpec& spec, const std::string& key) {
  const auto at = spec.places.find(key);
  return at == spec.places.end() ? spec.path + ":1:1" : at->second;
}

SweepSpec parse_sweep(const std::string& text, const std::string& path) {
  SweepSpec spec;
  SpecTables tables;
  spec.path = path;
  spec.places = models::read_toml(text, path, [&](Visitor& v) { describe(v, spec, tables); });
  for (AxisTable& table : tables.vary) {
    fill_levels(spec, table);
    spec.axes.push_back(std::move(table.axis));
  }
  spec.keep = split(tables.keep);
  if (spec.keep.empty()) refuse(spec, "keep", "'keep' is empty; expected measures such as 'contacts'");
  for (std::size_t i = 0; i < spec.keep.size(); ++i)
    if (std::find(spec.keep.begin(), spec.keep.begin() + static_cast<std::ptrdiff_t>(i), spec.keep[i]) !=
        spec.keep.begin() + static_cast<std::ptrdiff_t>(i))
      refuse(spec, "keep", fmt::format("'keep' names {} twice; leave one out", models::quoted(spec.keep[i])));
  count_points(spec);
  spec.scene = scene_path(spec);
  return spec;
}

SweepSpec load_sweep(const std::string& path) {
  std::string why;
  const std::string text = models::read_file(path, kLongest, why);
  if (!why.empty())
    throw Error(
        fmt::format("{}:1:1: cannot read this sweep: {}; expected a TOML file as in docs/guide/sweep.md; "
                    "correct the name",
                    path, why));
  return parse_sweep(text, path);
}

void check_axes(const SweepSpec& spec, const models::Setup& setup) {
  std::vector<std::string> names;
  for (const models::Parameter& p : models::parameters(setup)) names.push_back(p.name);
  for (const Axis& axis : spec.axes) {
    const std::string at = "vary." + axis.name;
    // A driver's own keys are known to its driver alone, which checks them.
    if (std::find(names.begin(), names.end(), axis.name) == names.end() &&
        axis.name.find(".driver.") == std::string::npos) {
      const std::string near = models::nearest_name(axis.name, names);
      refuse(spec, at + ".name",
             fmt::format("unknown parameter {}; expected a name of `encounter params {}`{}",
                         models::quoted(axis.name), spec.scene,
                         near.empty() ? "" : fmt::format("; did you mean {}?", models::quoted(near))));
    }
    std::vector<std::string> values = axis.levels;
    if (values.empty()) values = {axis.at(0.0), axis.at(1.0)};
    // A point between the ends: a whole number has none there.
    constexpr double kBetween = 0.381966;
    if (values.size() == 2 && axis.levels.empty() && axis.steps == 0) values.push_back(axis.at(kBetween));
    for (std::int64_t i = 0; i < std::min<std::int64_t>(axis.steps, 1000); ++i)
      values.push_back(axis.at(static_cast<double>(i) / static_cast<double>(axis.steps - 1)));
    models::Setup copy = setup;
    for (const std::string& value : values) {
      try {
        models::set(copy, axis.name + "=" + value);
      } catch (const Error& e) {
        refuse(spec, at, e.what());
      }
    }
  }
}

std::string design_text(const SweepSpec& spec) {
  std::string text = fmt::format("{} {} {} points {} seeds {} for {}\n", fs::path(spec.scene).stem().string(),
                                 spec.rig, word_of(spec.design), spec.points, spec.seeds, spec.seconds);
  for (const Axis& axis : spec.axes)
    text += fmt::format("{} [{}] {} {} {} {}\n", axis.name, fmt::join(axis.levels, ", "), axis.from, axis.to,
                        axis.steps, word_of(axis.scale));
  return text;
}

std::uint64_t text_hash(const std::string& text) {
  StateHash hash;
  for (const char c : text) hash.add(static_cast<unsigned char>(c));
  return hash.value;
}

}  // namespace enc::trial
