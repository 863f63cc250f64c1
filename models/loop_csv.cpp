#include "models/loop_csv.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "models/wording.h"

namespace enc::models {
namespace {

constexpr std::array<std::string_view, 4> kColumns{"time_s", "deflection_mm", "force_N", "repeat"};
enum : std::size_t { kTime, kDeflection, kForce, kRepeat };

struct Cell {
  std::string_view text;
  std::size_t column = 1;  // counts from 1, as editors do
};

std::vector<Cell> cells_of(std::string_view line) {
  std::vector<Cell> cells;
  for (std::size_t at = 0;;) {
    const std::size_t comma = std::min(line.find(',', at), line.size());
    std::string_view text = line.substr(at, comma - at);
    std::size_t column = at + 1;
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1), ++column;
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    cells.push_back({text, column});
    if (comma == line.size()) return cells;
    at = comma + 1;
  }
}

class Reader {
 public:
  Reader(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {}

  // Fills one list of readings for each repeat.
  std::map<std::int64_t, std::vector<LoopPoint>> read(std::string& remark) {
    std::string_view line;
    while (next(line) && (line.empty() || line.front() == '#')) {
      while (!line.empty() && (line.front() == '#' || line.front() == ' ')) line.remove_prefix(1);
      remark += (remark.empty() || line.empty() ? "" : " ") + std::string(line);
    }
    header(line);
    std::map<std::int64_t, std::vector<LoopPoint>> repeats;
    while (next(line))
      if (!line.empty()) row(cells_of(line), repeats);
    if (!origin_.empty()) remark = origin_;
    return repeats;
  }
  [[noreturn]] void fail(std::size_t column, const std::string& what) const {
    throw Error(fmt::format("{}:{}:{}: {}", name_, std::max<std::size_t>(line_, 1), column, what));
  }

 private:
  bool next(std::string_view& line) {
    line = {};
    if (text_.empty()) return false;
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    line = text_.substr(0, end);
    text_.remove_prefix(std::min(end + 1, text_.size()));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    ++line_;
    return true;
  }

  void header(std::string_view line) {
    const std::vector<Cell> cells = cells_of(line);
    std::vector<std::string> names;
    names.reserve(cells.size());
    for (const Cell& cell : cells) names.emplace_back(cell.text);
    for (std::size_t i = 0; i < kColumns.size(); ++i) {
      const auto found = std::find(names.begin(), names.end(), kColumns[i]);
      if (found == names.end()) {
        const std::string near = nearest_name(kColumns[i], names);
        fail(1,
             fmt::format(
                 "there is no column '{}'; expected a header with time_s, deflection_mm, force_N, repeat; {}",
                 kColumns[i],
                 near.empty() ? "name the columns in the first line"
                              : fmt::format("rename {}", quoted(near))));
      }
      if (std::find(found + 1, names.end(), kColumns[i]) != names.end())
        fail(1, fmt::format("there are two columns '{}'; expected one; rename the other", kColumns[i]));
      at_[i] = static_cast<std::size_t>(found - names.begin());
    }
    columns_ = cells.size();
    source_ = static_cast<std::size_t>(std::find(names.begin(), names.end(), "source") - names.begin());
  }

  double number(const Cell& cell, std::size_t which) const {
    double value = 0.0;
    const char* end = cell.text.data() + cell.text.size();
    const auto [stop, bad] = std::from_chars(cell.text.data(), end, value);
    if (bad != std::errc() || stop != end || !std::isfinite(value))
      fail(cell.column,
           fmt::format("'{}' is {}; expected a finite number such as 1.25; correct or remove the row",
                       kColumns[which], quoted(std::string(cell.text))));
    return value;
  }

  void row(const std::vector<Cell>& cells, std::map<std::int64_t, std::vector<LoopPoint>>& repeats) {
    if (cells.size() != columns_)
      fail(cells.back().column,
           fmt::format("this row has {} columns; expected {} as in the header; correct or remove it",
                       cells.size(), columns_));
    const double time = number(cells[at_[kTime]], kTime);
    if (!(time > time_))
      fail(cells[at_[kTime]].column,
           fmt::format("the time {} s does not come after {} s; expected increasing times; sort the rows",
                       cells[at_[kTime]].text, time_));
    time_ = time;
    const Cell& repeat = cells[at_[kRepeat]];
    const double which = repeat.text.empty() ? 0.0 : number(repeat, kRepeat);
    if (!(which >= 0.0 && which <= 1e6) || which != std::floor(which))
      fail(repeat.column,
           fmt::format("'repeat' is {}; expected a whole number, 0 or nothing outside of a press; "
                       "correct it",
                       quoted(std::string(repeat.text))));
    // A rig that has not found its zero yet has no force to tell; outside of a press nothing is lost by that.
    const auto reading = [&](std::size_t column) {
      const Cell& cell = cells[at_[column]];
      return which == 0.0 && cell.text.empty() ? 0.0 : number(cell, column);
    };
    const LoopPoint point{reading(kDeflection) * 1e-3, reading(kForce)};
    if (which == 0.0 || !(point.deflection > 0.0)) return;
    if (repeats.empty() && source_ < cells.size()) origin_ = cells[source_].text;
    repeats[static_cast<std::int64_t>(which)].push_back(point);
  }

  std::string_view text_;
  std::string name_;
  std::size_t line_ = 0, columns_ = 0, source_ = 0;
  std::string origin_;
  std::array<std::size_t, kColumns.size()> at_{};
  double time_ = -std::numeric_limits<double>::infinity();
};

// Pressing or releasing, by the travel over a window of readings, which a coarse or noisy position does not
// turn around. What travels less than a quarter of the usual is at standstill or turns.
std::vector<LoopPoint> branches(std::vector<LoopPoint>& press) {
  const auto n = static_cast<std::ptrdiff_t>(press.size());
  const std::ptrdiff_t half = std::clamp<std::ptrdiff_t>(n / 100, 1, 20);
  std::vector<double> travel;
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const auto from = static_cast<std::size_t>(std::max<std::ptrdiff_t>(i - half, 0));
    const auto to = static_cast<std::size_t>(std::min(i + half, n - 1));
    travel.push_back(press[to].deflection - press[from].deflection);
  }
  std::vector<double> sizes;
  sizes.reserve(travel.size());
  for (const double t : travel) sizes.push_back(std::abs(t));
  std::sort(sizes.begin(), sizes.end());
  const double usual = sizes.empty() ? 0.0 : sizes[sizes.size() * 3 / 4];
  std::vector<LoopPoint> moving;
  for (std::size_t i = 0; i < press.size(); ++i) {
    press[i].pressing = travel[i] >= 0.0;
    if (std::abs(travel[i]) > 0.25 * usual) moving.push_back(press[i]);
  }
  return moving;
}

// What the whole file must say; `where` is its end.
void check(const Reader& where, const LoopData& loop, double limit) {
  constexpr std::ptrdiff_t kFewest = 20;
  constexpr double kNear = 0.05e-3;  // m (decisions 6)
  double deepest = 0.0;
  std::ptrdiff_t pressing = 0;
  std::ptrdiff_t releasing = 0;
  for (const auto& press : loop.presses)
    for (const LoopPoint& point : press) deepest = std::max(deepest, point.deflection);
  for (const auto& press : loop.moving)
    for (const LoopPoint& point : press) ++(point.pressing ? pressing : releasing);
  if (loop.presses.empty())
    where.fail(
        1,
        "no reading belongs to a press; expected rows with repeat 1, 2, ... and deflection_mm above 0; "
        "fill the column 'repeat'");
  if (deepest < limit - kNear)
    where.fail(
        1, fmt::format("the deepest deflection is {:.3f} mm; expected {:g} mm, the limit; press deeper, or "
                       "give --limit-mm {:g}",
                       deepest * 1e3, limit * 1e3, std::floor(deepest * 1e4) / 10.0));
  if (pressing < kFewest || releasing < kFewest)
    where.fail(
        1, fmt::format("there are {} readings while {}; expected at least {} on either branch; record the "
                       "whole loop",
                       pressing < kFewest ? pressing : releasing,
                       pressing < kFewest ? "pressing" : "releasing", kFewest));
}

}  // namespace

LoopData parse_loop(const std::string& text, const std::string& name, double limit) {
  Reader reader(text, name);
  LoopData loop;
  auto repeats = reader.read(loop.remark);
  for (auto& [repeat, press] : repeats) {
    loop.moving.push_back(branches(press));
    loop.presses.push_back(std::move(press));
  }
  check(reader, loop, limit);
  return loop;
}

}  // namespace enc::models
