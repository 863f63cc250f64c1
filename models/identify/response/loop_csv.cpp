#include "models/identify/response/loop_csv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/LU>
#include <fmt/format.h>

#include "core/base/frames.h"
#include "models/identify/response/contact.h"
#include "models/identify/response/response_fit.h"
#include "models/order_statistics.h"
#include "models/schema/wording.h"
#include "models/tables/csv_reader.h"

namespace enc::models {
namespace {

// A force that stays constant while the deflection grows: a sensor at its limit, or an object that yields.
// Deflection, m, and time, s, at which the force stops rising; unset: it rises to the deepest reading.
struct Plateau {
  double from = kUnset, time = kUnset;
};

// The grain of a force, N: its noise between readings, or its steps if these are larger.
double grain_of(std::span<const LoopPoint> moving) {
  std::vector<double> forces;
  forces.reserve(moving.size());
  for (const LoopPoint& p : moving) forces.push_back(p.force);
  double step = INFINITY;
  for (std::size_t i = 1; i < forces.size(); ++i)
    if (const double by = std::abs(forces[i] - forces[i - 1]); by > 0.0) step = std::min(step, by);
  return std::max(position_noise(forces), std::isfinite(step) ? step : 0.0);
}

// The force rises by this much along a line through the press between two deflections, N.
double rise_between(std::span<const LoopPoint> moving, double from, double to) {
  double n = 0.0, d = 0.0, f = 0.0, dd = 0.0, df = 0.0;
  for (const LoopPoint& p : moving) {
    if (!p.pressing || p.deflection < from || p.deflection > to) continue;
    n += 1.0, d += p.deflection, f += p.force;
    dd += p.deflection * p.deflection, df += p.deflection * p.force;
  }
  return (df - d * f / n) / (dd - d * d / n) * (to - from);
}

// Takes the readings of one press, of either branch, in order of time.
Plateau plateau_of(std::span<const LoopPoint> moving) {
  // A plateau begins so many grains below the largest force.
  constexpr double kNear = 4.0;
  // The force rises over the plateau by fewer grains than this. It also rises by less than this share of the
  // rise over an equal distance before.
  constexpr double kFlat = 2.0, kShare = 0.25;
  // It is longer than this share of the depth.
  constexpr double kShortest = 0.02;
  const double grain = grain_of(moving);
  double top = -INFINITY, deepest = 0.0;
  for (const LoopPoint& p : moving) {
    if (!p.pressing) continue;
    top = std::max(top, p.force);
    deepest = std::max(deepest, p.deflection);
  }
  Plateau flat;
  for (const LoopPoint& p : moving)
    if (p.pressing && p.force >= top - kNear * grain && !(p.deflection >= flat.from))
      flat = {p.deflection, p.time};
  const double way = deepest - flat.from;
  if (!(way > kShortest * deepest)) return {};
  const double rise = rise_between(moving, flat.from, deepest);
  return rise < kFlat * grain && rise < kShare * rise_between(moving, flat.from - way, flat.from) ? flat
                                                                                                  : Plateau{};
}

// ---- The branches of a press: pressing and releasing, at any ratio of their speeds and with any hold
// between.

constexpr double kOfUsual = 0.25;     // share of the usual travel: with less, the probe stands still or turns
constexpr double kTurnNoise = 8.0;    // standard deviations: closer to the deepest reading, branches mix
constexpr double kSameGround = 0.01;  // share of the depth: a reading farther out repeats a range
constexpr int kLevels = 16;           // levels of depth for measuring the speed

struct Branch {
  std::size_t from = 0, to = 0;  // readings of the press; `to` is excluded
  double sign = 1.0;             // of the travel

  // The k-th reading, counted from the outside inwards.
  [[nodiscard]] std::size_t inwards(std::size_t k) const { return sign > 0.0 ? from + k : to - 1 - k; }
};

// Usual travel between two readings, m: the median over levels of depth, so that neither a hold nor a slow
// end dominates it.
double usual_step(std::span<const double> depth, const Branch& branch, double deepest) {
  std::vector<double> crossed, readings;
  int level = 1;
  for (std::size_t k = 0; k < branch.to - branch.from; ++k) {
    const double d = depth[branch.inwards(k)];
    for (; level < kLevels && d > deepest * level / kLevels; ++level) {
      if (k == 0) continue;
      const double before = depth[branch.inwards(k - 1)];
      crossed.push_back(static_cast<double>(k) - (d - deepest * level / kLevels) / (d - before));
    }
  }
  for (std::size_t k = 1; k < crossed.size(); ++k) readings.push_back(crossed[k] - crossed[k - 1]);
  const double usual = median(readings);
  return usual > 0.0 ? deepest / kLevels / usual : deepest;
}

struct Window {
  std::ptrdiff_t half = 1;  // readings
  double threshold = 0.0;   // m: with less travel over the window it is at standstill
  double step = 0.0;        // m, of the branch, from one reading to the next
};

// The window is as long as noise requires, so that a hold does not count as motion.
Window window_of(std::span<const double> depth, const Branch& branch, double deepest, double noise) {
  constexpr double kShare = 1.0 / 50.0;  // of a branch
  constexpr double kOver = 14.0;         // standard deviations of travel at usual speed; the threshold has 5
  const double step = usual_step(depth, branch, deepest);
  const double moving = deepest / step;  // readings
  double half = std::clamp(moving * kShare, 1.0, 20.0);
  half = std::max(half, std::min(std::ceil(kOver * noise / step), moving / 8.0));
  Window window;
  window.half = std::max<std::ptrdiff_t>(1, static_cast<std::ptrdiff_t>(half));
  window.threshold = kOfUsual * 2.0 * static_cast<double>(window.half) * step;
  window.step = step;
  return window;
}

// Marks runs of readings at standstill that are longer than the window, and the readings within reach of it
// on either side.
std::vector<bool> holds_in(const std::vector<bool>& still, std::ptrdiff_t half) {
  std::vector<bool> held(still.size(), false);
  const auto n = static_cast<std::ptrdiff_t>(still.size());
  const auto is_still = [&](std::ptrdiff_t i) { return still[static_cast<std::size_t>(i)]; };
  for (std::ptrdiff_t from = 0, to = 0; from < n; from = to) {
    for (to = from; to < n && is_still(to) == is_still(from);) ++to;
    if (!is_still(from) || to - from <= 2 * half) continue;
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, from - half); i < std::min(n, to + half); ++i)
      held[static_cast<std::size_t>(i)] = true;
  }
  return held;
}

struct Motion {
  std::vector<bool> moves;  // along the branch
  std::vector<bool> held;
};
Motion motion_in(std::span<const double> depth, const Branch& branch, const Window& window) {
  const auto n = static_cast<std::ptrdiff_t>(depth.size());
  Motion motion{std::vector<bool>(depth.size()), {}};
  std::vector<bool> still(depth.size());
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const auto before = static_cast<std::size_t>(std::max<std::ptrdiff_t>(i - window.half, 0));
    const auto after = static_cast<std::size_t>(std::min(i + window.half, n - 1));
    const double travel = branch.sign * (depth[after] - depth[before]);
    motion.moves[static_cast<std::size_t>(i)] = travel > window.threshold;
    still[static_cast<std::size_t>(i)] = std::abs(travel) <= window.threshold;
  }
  motion.held = holds_in(still, window.half);
  return motion;
}

// The readings at which the motion reverses by more than `least`, and the first and the last reading.
std::vector<std::size_t> turns_in(std::span<const double> depth, double least) {
  std::vector<std::size_t> turns{0};
  std::size_t low = 0, high = 0;
  int way = 0;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (depth[i] < depth[low]) low = i;
    if (depth[i] > depth[high]) high = i;
    if (way >= 0 && depth[i] < depth[high] - least) {
      turns.push_back(high);
      way = -1, low = i;
    } else if (way <= 0 && depth[i] > depth[low] + least) {
      turns.push_back(low);
      way = 1, high = i;
    }
  }
  turns.push_back(depth.size() - 1);
  return turns;
}

// Marks the tremor of a hand that holds a depth: its strokes are too short for a press.
std::vector<bool> tremor_in(std::span<const double> depth, double least, double deepest) {
  // A tremor's stroke is no longer than this, m, and than this share of the depth.
  constexpr double kLongest = 0.8e-3, kShare = 0.25;
  const double most = std::min(kLongest, kShare * deepest);
  std::vector<bool> trembles(depth.size(), false);
  const std::vector<std::size_t> turns = turns_in(depth, least);
  for (std::size_t k = 1; k < turns.size(); ++k) {
    // The first and the last stroke belong to a press.
    const bool inner = k > 1 && k + 1 < turns.size();
    if (!inner || std::abs(depth[turns[k]] - depth[turns[k - 1]]) > most) continue;
    for (std::size_t i = turns[k - 1]; i <= turns[k]; ++i) trembles[i] = true;
  }
  return trembles;
}

// Leaves out readings over a range that the branch has covered before.
void leave_minor_loops(std::span<const double> depth, const Branch& branch, double margin,
                       const std::vector<bool>& trembles, std::vector<bool>& moves) {
  double covered = -INFINITY;
  for (std::size_t i = branch.from; i < branch.to; ++i) {
    if (trembles[i]) continue;
    const double along = branch.sign * depth[i];
    if (along < covered - margin) moves[i] = false;
    covered = std::max(covered, along);
  }
}

// The middle of a press, and the readings around it that belong to neither branch: first to last.
struct Turn {
  std::size_t at = 0, first = 0, last = 0;

  // A turn without a hold, at similar speeds: windows across it show no travel, so the readings near it are
  // already left out.
  [[nodiscard]] bool sharp(const Window& in, const Window& out, double margin) const {
    constexpr double kAlike = 1.25, kSpare = 2.0;
    const double readings = margin / in.step + margin / out.step;
    return std::max(in.step, out.step) <= kAlike * std::min(in.step, out.step) &&
           static_cast<double>(last - first) <= kAlike * readings + kSpare;
  }
};
Turn turn_of(const std::vector<double>& depth, double edge) {
  const auto at_top = [&](double d) { return d >= edge; };
  Turn turn;
  turn.first = static_cast<std::size_t>(std::find_if(depth.begin(), depth.end(), at_top) - depth.begin());
  turn.last = depth.size() - 1 -
              static_cast<std::size_t>(std::find_if(depth.rbegin(), depth.rend(), at_top) - depth.rbegin());
  turn.at = (turn.first + turn.last) / 2;
  return turn;
}

// Splits a press at its deepest reading: sets `pressing` and `held` of each reading, and returns those of
// either branch, in order of time. It leaves out readings within the noise of the deepest one. It also leaves
// out readings at standstill (a motion of less than a quarter of the branch's usual speed), and readings over
// a range that the branch has covered before (a minor loop).
std::vector<LoopPoint> split_branches(std::vector<LoopPoint>& press) {
  if (press.empty()) return {};
  std::vector<double> raw;
  raw.reserve(press.size());
  for (const LoopPoint& p : press) raw.push_back(p.deflection);
  const double noise = position_noise(raw), margin = kTurnNoise * noise;
  const std::vector<double> depth = without_spikes(std::move(raw));
  const double top = *std::max_element(depth.begin(), depth.end());
  const Turn turn = turn_of(depth, top - margin);
  const Branch in{0, turn.at + 1, 1.0}, out{turn.at, press.size(), -1.0};
  const Window window_in = window_of(depth, in, top, noise), window_out = window_of(depth, out, top, noise);
  const bool sharp = turn.sharp(window_in, window_out, margin);
  const double wobble = std::max(margin, kSameGround * top);
  const std::vector<bool> trembles = tremor_in(depth, wobble, top);
  std::vector<bool> kept(press.size(), false);
  for (const Branch& branch : {in, out}) {
    Motion motion = motion_in(depth, branch, branch.sign > 0.0 ? window_in : window_out);
    leave_minor_loops(depth, branch, wobble, trembles, motion.moves);
    for (std::size_t i = branch.from; i < branch.to; ++i) {
      press[i].held = motion.held[i] || trembles[i] || (!sharp && i >= turn.first && i <= turn.last);
      kept[i] = motion.moves[i] && !press[i].held;
    }
  }
  std::vector<LoopPoint> moving;
  for (std::size_t i = 0; i < press.size(); ++i) {
    press[i].pressing = i <= turn.at;
    if (kept[i]) moving.push_back(press[i]);
  }
  return moving;
}

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

// Time must increase. The usual cause if it does not: the clock restarts with each repeat.
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
    constexpr double kNearFirst = 0.1;  // share of the time so far
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
    // A rig without a zero yet reports no force; outside of a press that does no harm.
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

// Readings in contact, with corrected force zero and begin of contact.
std::vector<LoopPoint> in_contact(std::span<const LoopRow> rows, const PressRows& press, std::size_t which,
                                  const Contact& contact) {
  std::vector<LoopPoint> points;
  // If contact does not begin at 0, the file's marks may be wrong about the rows in contact.
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

// A line through force over deflection of the pressing branch: its rise up to the limit, and the scatter
// about it.
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

// The force at 0 mm, from the outermost readings of one branch of the presses.
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

// A file that begins in contact has no zero of its own, so its force must begin at 0 N and 0 mm. Returns a
// note if it begins near that, but not by chance.
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

// Such a file has no zero after contact either. A release that ends with another force than the press began
// with has drifted, or the object clings. Returns a note.
std::string check_end(const LoopData& loop, double limit, double rise) {
  // The ends may differ by this share of the rise, or by this many standard deviations.
  constexpr double kMost = 0.04, kBeyondChance = 6.0;
  const Start start = start_of(loop, limit, true), end = start_of(loop, limit, false);
  const double apart = end.force - start.force;
  // Adding 0.0 removes the sign of a rounded -0.
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

// A force beyond any hand is in another unit than newtons.
void check_force(const CsvReader& where, const LoopData& loop, double limit) {
  // Neither a hand nor a table-top machine presses with more, N.
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

// Checks the whole file; `where` is its end.
void check(const CsvReader& where, LoopData& loop, double limit, bool zero_known) {
  constexpr std::ptrdiff_t kFewest = 20;
  constexpr double kLeastForce = 1e-3;  // N: a smaller force is no reading of a force sensor
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

// A sensor at its limit only shows that the force is larger.
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
