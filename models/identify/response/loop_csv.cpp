#include "models/identify/response/loop_csv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>

#include <Eigen/LU>
#include <fmt/format.h>

#include "models/identify/response/branches.h"
#include "models/identify/response/contact.h"
#include "models/identify/response/plateau.h"
#include "models/schema/wording.h"
#include "models/tables/csv_reader.h"

namespace enc::models {
namespace {

enum : std::size_t { kTime, kDeflection, kForce, kRepeat, kSource };

std::int64_t repeat_of(const CsvReader& row) {
  if (row.text(kRepeat).empty()) return 0;
  const double which = row.number(kRepeat);
  if (!(which >= 0.0 && which <= 1e6) || which != std::floor(which))
    row.fail(kRepeat, fmt::format("'repeat' is {}; expected a whole number, 0 or nothing outside of a press; "
                                  "correct it",
                                  quoted(std::string(row.text(kRepeat)))));
  return static_cast<std::int64_t>(which);
}

// Times go forwards. A clock that each repeat starts anew is the usual reason where they do not.
class Clock {
 public:
  double next(const CsvReader& row, std::int64_t repeat) {
    const double time = row.number(kTime);
    if (count_ > 0 && !(time > before_)) fail(row, time, repeat);
    if (count_++ == 0) first_ = time;
    before_ = time;
    if (repeat > 0) last_repeat_ = repeat;
    return time;
  }

 private:
  [[noreturn]] void fail(const CsvReader& row, double time, std::int64_t repeat) const {
    constexpr double kNearFirst = 0.1;  // of the time so far
    const bool changes = repeat != last_repeat_ && time - first_ <= kNearFirst * (before_ - first_);
    if (count_ > 2 && (changes || time <= first_))
      row.fail(kTime,
               fmt::format("the time {} s comes after {} s: time begins anew {}; expected one clock for the "
                           "whole file; add the last time of a repeat to all times of the next",
                           row.text(kTime), before_, place(repeat)));
    row.fail(kTime,
             fmt::format("the time {} s does not come after {} s; expected increasing times; sort the rows",
                         row.text(kTime), before_));
  }
  [[nodiscard]] std::string place(std::int64_t repeat) const {
    if (repeat > 0 && repeat != last_repeat_) return fmt::format("at repeat {}", repeat);
    return last_repeat_ > 0 ? fmt::format("after repeat {} began", last_repeat_) : "here";
  }

  std::size_t count_ = 0;
  double first_ = 0.0, before_ = 0.0;
  std::int64_t last_repeat_ = 0;
};

std::vector<LoopRow> read(CsvReader& row, std::string& remark) {
  row.header({"time_s", "deflection_mm", "force_N", "repeat"}, {"source"});
  remark = row.remark();
  std::vector<LoopRow> rows;
  Clock clock;
  bool sourced = false;
  while (row.next()) {
    const std::int64_t which = repeat_of(row);
    LoopRow reading{clock.next(row, which), 0.0, kUnset, which, row.line()};
    // A rig that has not found its zero yet has no force to tell; outside of a press nothing is lost by that.
    const auto given = [&](std::size_t column) { return which != 0 || !row.text(column).empty(); };
    if (given(kForce)) reading.force = row.number(kForce);
    if (!given(kDeflection)) continue;
    reading.deflection = row.number(kDeflection) * 1e-3;
    if (which != 0 && !sourced && !row.text(kSource).empty()) {
      remark = row.text(kSource);
      sourced = true;
    }
    rows.push_back(reading);
  }
  return rows;
}

// Readings in contact, with the zero of the force and the begin of contact put right.
std::vector<LoopPoint> in_contact(std::span<const LoopRow> rows, const PressRows& press, std::size_t which,
                                  const Contact& contact) {
  std::vector<LoopPoint> points;
  // If contact begins elsewhere than at 0, the file's marks may be wrong about the rows in contact.
  const std::size_t from = contact.shift ? press.from : press.first;
  const std::size_t to = contact.shift ? press.to : press.last;
  for (std::size_t i = from; i <= to; ++i) {
    const LoopRow& row = rows[i];
    if (std::isnan(row.force) || (row.repeat == 0 && !contact.shift)) continue;
    const double deflection = row.deflection - contact.begin();
    if (deflection > 0.0)
      points.push_back({deflection, row.force - contact.zero_at(which, row.time), true, row.time});
  }
  return points;
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

// The force at 0 mm, by the outermost readings of one branch of the presses.
struct Start {
  double force = 0.0, error = kUnset;  // N
  double slope = 0.0;                  // N/m
};
Start start_of(const LoopData& loop, double limit, bool pressing) {
  constexpr double kFirst = 0.1;  // of the limit
  double least = INFINITY;
  for (const auto& press : loop.moving)
    for (const LoopPoint& p : press)
      if (p.pressing == pressing) least = std::min(least, p.deflection);
  Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double squares = 0.0, n = 0.0;
  for (const auto& press : loop.moving)
    for (const LoopPoint& p : press) {
      if (p.pressing != pressing || p.deflection > least + kFirst * limit) continue;
      const double u = p.deflection / limit;
      const Eigen::Vector3d row(1.0, u, u * u);
      gram += row * row.transpose();
      right += row * p.force;
      squares += p.force * p.force;
      n += 1.0;
    }
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(gram);
  if (n < 10.0 || !lu.isInvertible()) return {};
  const Eigen::Matrix3d inverse = lu.inverse();
  const Eigen::Vector3d x = inverse * right;
  const double variance = std::max(0.0, squares - x.dot(right)) / (n - 3.0);
  return {x[0], std::sqrt(variance * inverse(0, 0)), (x[1] + 2.0 * x[2] * least / limit) / limit};
}

// A file that begins in contact has no zero of its own: its force has to begin at 0 N and 0 mm. Returns a
// note where it begins near to that, but not by chance.
std::string check_start(const CsvReader& where, const LoopData& loop, double limit, double rise) {
  constexpr double kMost = 0.04;         // of the rise
  constexpr double kWorthANote = 0.002;  // of the rise
  constexpr double kBeyondChance = 6.0;  // standard deviations
  const Start start = start_of(loop, limit, true);
  if (!(std::abs(start.force) > std::max(kWorthANote * rise, kBeyondChance * start.error))) return "";
  if (!(std::abs(start.force) > kMost * rise))
    return fmt::format(
        "at 0 mm the force is {:.2f} N, and no reading from before contact gives its zero: the curve "
        "may be off by as much",
        start.force);
  if (start.force < 0.0 && start.slope > 0.0)
    where.fail_line(fmt::format(
        "contact begins at {:.2f} mm, and no reading from before it gives the zero of the force; expected "
        "contact to begin at 0 mm; record from before contact, or take {:.2f} mm away from deflection_mm",
        -start.force / start.slope * 1e3, -start.force / start.slope * 1e3));
  where.fail_line(fmt::format(
      "at 0 mm the force is {:.2f} N, and no reading from before contact gives its zero; expected 0 N; "
      "record from before contact, or correct the zero of force_N or of deflection_mm",
      start.force));
}

// Nor has such a file a zero after contact: a release that ends with another force than the press began with
// has drifted, or clings. Returns a note.
std::string check_end(const LoopData& loop, double limit, double rise) {
  // The ends may differ by this share of the rise, or by so many standard deviations.
  constexpr double kMost = 0.04, kBeyondChance = 6.0;
  const Start start = start_of(loop, limit, true), end = start_of(loop, limit, false);
  const double apart = end.force - start.force;
  // A force that is almost nothing has no sign.
  const auto rounded = [](double force) { return std::round(force * 1e2) / 1e2 + 0.0; };
  if (!(std::abs(apart) > std::max(kMost * rise, kBeyondChance * std::hypot(start.error, end.error))))
    return "";
  return fmt::format(
      "the press begins with {:.2f} N at 0 mm and the release ends with {:.2f} N: the zero of the force "
      "drifts, "
      "or the object clings, and no reading from outside of contact tells which: the release may be off by "
      "as "
      "much; record from before contact until after it",
      rounded(start.force), rounded(end.force));
}

void check_depth(const CsvReader& where, const LoopData& loop, double limit) {
  constexpr double kNear = 0.05e-3;  // m (sources/hand 3)
  constexpr double kUnit = 1e3;
  double deepest = 0.0;
  for (const auto& press : loop.presses)
    for (const LoopPoint& point : press) deepest = std::max(deepest, point.deflection);
  const auto fits = [&](double factor) {
    return deepest * factor >= 0.5 * limit && deepest * factor <= 3.0 * limit;
  };
  if (const bool metres = fits(kUnit); metres || fits(1.0 / kUnit))
    where.fail_line(
        fmt::format("the deepest deflection is {:.4g} mm; expected about {:g} mm; if deflection_mm is in {}, "
                    "multiply it by {:g}",
                    deepest * 1e3, limit * 1e3, metres ? "m" : "micrometres", metres ? kUnit : 1.0 / kUnit));
  if (deepest < 0.01 * limit)
    where.fail_line(
        fmt::format("the deepest deflection is {:.3f} mm; expected {:g} mm, the limit; see to the sign "
                    "and the column of deflection_mm: into the object it is positive",
                    deepest * 1e3, limit * 1e3));
  if (deepest < limit - kNear)
    where.fail_line(
        fmt::format("the deepest deflection is {:.3f} mm; expected {:g} mm, the limit; press deeper, or "
                    "give --limit-mm {:g}",
                    deepest * 1e3, limit * 1e3, std::floor(deepest * 1e4) / 10.0));
}

// What no hand presses is in another unit than newtons.
void check_force(const CsvReader& where, const LoopData& loop, double limit) {
  // No hand and no machine of a table presses with more, N.
  constexpr double kMost = 300.0;
  struct Unit {
    double in_newtons;
    std::string_view name;
  };
  constexpr std::array<Unit, 2> kUnits{{{1e-3, "mN"}, {9.80665e-3, "gram-force"}}};
  double most = 0.0;
  for (const auto& press : loop.presses)
    for (const LoopPoint& point : press)
      if (point.deflection <= limit) most = std::max(most, std::abs(point.force));
  if (!(most > kMost)) return;
  std::string advice;
  for (const Unit& unit : kUnits)
    if (unit.in_newtons * most <= kMost)
      advice += fmt::format("{} {}, multiply it by {:g}", advice.empty() ? "if force_N is in" : "; if in",
                            unit.name, unit.in_newtons);
  where.fail_line(
      fmt::format("the force reaches {:.0f} N within {:g} mm; expected at most {:g} N, as hands and haptic "
                  "machines press; {}",
                  most, limit * 1e3, kMost, advice.empty() ? "see to the unit of force_N" : advice));
}

// What the whole file must say; `where` is its end.
void check(const CsvReader& where, LoopData& loop, double limit, bool zero_known) {
  constexpr std::ptrdiff_t kFewest = 20;
  constexpr double kLeastForce = 1e-3;  // N: less is no reading of a force sensor
  std::ptrdiff_t pressing = 0;
  std::ptrdiff_t releasing = 0;
  for (const auto& press : loop.moving)
    for (const LoopPoint& point : press) ++(point.pressing ? pressing : releasing);
  if (loop.presses.empty())
    where.fail_line(
        "no reading belongs to a press; expected rows with repeat 1, 2, ... and deflection_mm above 0; "
        "fill the column 'repeat'");
  check_depth(where, loop, limit);
  check_force(where, loop, limit);
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
  if (zero_known) return;
  const std::string note = check_start(where, loop, limit, rise.force);
  if (!note.empty()) loop.notes.push_back(note);
  const std::string end = check_end(loop, limit, rise.force);
  if (end.empty()) return;
  loop.notes.push_back(end);
  loop.doubted = true;
}

// A sensor at its limit says no more than that the force is larger.
[[noreturn]] void fail_at_limit(const CsvReader& where, std::span<const LoopRow> rows, const Plateau& flat) {
  const auto row = std::lower_bound(rows.begin(), rows.end(), flat.time,
                                    [](const LoopRow& one, double time) { return one.time < time; });
  where.fail_line(
      row->line,
      fmt::format(
          "from {:.2f} mm on the force stays at {:.2f} N while it is pressed deeper: the sensor is at "
          "its limit, or the object yields; expected a force that rises up to the deepest reading; "
          "take a larger range of the sensor, or give --limit-mm {:g}",
          flat.from * 1e3, row->force, std::floor(flat.from * 1e4) / 10.0));
}

}  // namespace

LoopData parse_loop(const std::string& text, const std::string& name, double limit) {
  CsvReader reader(text, name);
  LoopData loop;
  const std::vector<LoopRow> rows = read(reader, loop.remark);
  const std::vector<PressRows> presses = presses_in(rows);
  const Contact contact = find_contact(rows, presses);
  for (std::size_t k = 0; k < presses.size(); ++k) {
    std::vector<LoopPoint> press = in_contact(rows, presses[k], k, contact);
    if (press.empty()) continue;
    for (const LoopPoint& p : press)
      if (!std::isfinite(p.force) || !std::isfinite(p.deflection))
        reader.fail_line(
            "a reading is too large for a number once its zero is subtracted; expected readings of a rig; "
            "correct or remove the row");
    loop.moving.push_back(split_branches(press));
    if (const Plateau flat = plateau_of(loop.moving.back()); flat.from <= limit)
      fail_at_limit(reader, rows, flat);
    loop.presses.push_back(std::move(press));
  }
  loop.notes = contact.notes();
  loop.doubted = contact.doubted();
  loop.zero_error = contact.zero_error();
  loop.begin_error = contact.begin_error();
  check(reader, loop, limit, std::any_of(contact.zeros.begin(), contact.zeros.end(), [](const PressZero& z) {
          return z.known();
        }));
  return loop;
}

}  // namespace enc::models
