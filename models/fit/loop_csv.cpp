#include "models/fit/loop_csv.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "models/csv_reader.h"
#include "models/schema/wording.h"

namespace enc::models {
namespace {

enum : std::size_t { kTime, kDeflection, kForce, kRepeat, kSource };
using Repeats = std::map<std::int64_t, std::vector<LoopPoint>>;

std::int64_t repeat_of(const CsvReader& row) {
  if (row.text(kRepeat).empty()) return 0;
  const double which = row.number(kRepeat);
  if (!(which >= 0.0 && which <= 1e6) || which != std::floor(which))
    row.fail(kRepeat, fmt::format("'repeat' is {}; expected a whole number, 0 or nothing outside of a press; "
                                  "correct it",
                                  quoted(std::string(row.text(kRepeat)))));
  return static_cast<std::int64_t>(which);
}

// One list of readings for each repeat, and who measured them.
Repeats read(CsvReader& row, std::string& remark) {
  row.header({"time_s", "deflection_mm", "force_N", "repeat"}, {"source"});
  remark = row.remark();
  Repeats repeats;
  double before = -std::numeric_limits<double>::infinity();
  while (row.next()) {
    const double time = row.number(kTime);
    if (!(time > before))
      row.fail(kTime,
               fmt::format("the time {} s does not come after {} s; expected increasing times; sort the rows",
                           row.text(kTime), before));
    before = time;
    const std::int64_t which = repeat_of(row);
    // A rig that has not found its zero yet has no force to tell; outside of a press nothing is lost by that.
    const auto reading = [&](std::size_t column) {
      return which == 0 && row.text(column).empty() ? 0.0 : row.number(column);
    };
    const LoopPoint point{reading(kDeflection) * 1e-3, reading(kForce), true, time};
    if (which == 0 || !(point.deflection > 0.0)) continue;
    if (repeats.empty() && !row.text(kSource).empty()) remark = row.text(kSource);
    repeats[which].push_back(point);
  }
  return repeats;
}

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

// A line through force over deflection of what is pressed: how far the force rises along it up to the limit,
// and what scatters about it.
struct Rise {
  double force = 0.0, scatter = 0.0;  // N
};
Rise rise_of(const std::vector<std::vector<LoopPoint>>& moving, double limit) {
  double n = 0, d = 0, f = 0, dd = 0, df = 0, ff = 0;
  for (const auto& press : moving)
    for (const LoopPoint& p : press) {
      if (!p.pressing) continue;
      n += 1, d += p.deflection, f += p.force;
      dd += p.deflection * p.deflection, df += p.deflection * p.force, ff += p.force * p.force;
    }
  const double spread = dd - d * d / n, slope = (df - d * f / n) / spread;
  return {slope * limit, std::sqrt(std::max(0.0, ff - f * f / n - slope * slope * spread) / n)};
}

// What the whole file must say; `where` is its end.
void check(const CsvReader& where, const LoopData& loop, double limit) {
  constexpr std::ptrdiff_t kFewest = 20;
  constexpr double kNear = 0.05e-3;     // m (sources/hand 3)
  constexpr double kLeastForce = 1e-3;  // N: less is no reading of a force sensor
  double deepest = 0.0;
  std::ptrdiff_t pressing = 0;
  std::ptrdiff_t releasing = 0;
  for (const auto& press : loop.presses)
    for (const LoopPoint& point : press) deepest = std::max(deepest, point.deflection);
  for (const auto& press : loop.moving)
    for (const LoopPoint& point : press) ++(point.pressing ? pressing : releasing);
  if (loop.presses.empty())
    where.fail_line(
        "no reading belongs to a press; expected rows with repeat 1, 2, ... and deflection_mm above 0; "
        "fill the column 'repeat'");
  if (deepest < limit - kNear)
    where.fail_line(
        fmt::format("the deepest deflection is {:.3f} mm; expected {:g} mm, the limit; press deeper, or "
                    "give --limit-mm {:g}",
                    deepest * 1e3, limit * 1e3, std::floor(deepest * 1e4) / 10.0));
  if (pressing < kFewest || releasing < kFewest)
    where.fail_line(fmt::format(
        "there are {} readings while {}; expected at least {} on either branch; record the "
        "whole loop",
        pressing < kFewest ? pressing : releasing, pressing < kFewest ? "pressing" : "releasing", kFewest));
  const Rise rise = rise_of(loop.moving, limit);
  if (!(rise.force > rise.scatter) || !(rise.force > kLeastForce))
    where.fail_line(fmt::format(
        "pressed to {:g} mm the force rises by {:.3f} N and scatters by {:.3f} N; expected a force "
        "that rises with the deflection; see to the sign and the column of force_N",
        limit * 1e3, rise.force, rise.scatter));
}

}  // namespace

LoopData parse_loop(const std::string& text, const std::string& name, double limit) {
  CsvReader reader(text, name);
  LoopData loop;
  auto repeats = read(reader, loop.remark);
  for (auto& [repeat, press] : repeats) {
    loop.moving.push_back(branches(press));
    loop.presses.push_back(std::move(press));
  }
  check(reader, loop, limit);
  return loop;
}

}  // namespace enc::models
