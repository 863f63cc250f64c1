#include "models/identify/response/contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <fmt/format.h>

#include "models/order_statistics.h"

namespace enc::models {
namespace {

// Rows with one repeat number, including rows without a number between them.
std::vector<PressRows> marked(std::span<const LoopRow> rows) {
  std::vector<PressRows> presses;
  std::int64_t repeat = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].repeat == 0) continue;
    if (rows[i].repeat != repeat) presses.push_back({i, i, i, i, i});
    presses.back().last = i;
    repeat = rows[i].repeat;
  }
  return presses;
}

struct Extent {
  double low = INFINITY, high = -INFINITY;
  void take(double x) { low = std::min(low, x), high = std::max(high, x); }
  [[nodiscard]] double at(double share) const { return low + share * (high - low); }
};

// Cuts a press that was released in between, at the outermost deflection there.
void add_pieces(std::span<const LoopRow> rows, const PressRows& press, std::vector<PressRows>& pieces) {
  constexpr double kReleased = 0.05, kPressed = 0.5;  // of the force
  constexpr int kFew = 3;                             // readings: fewer of them are noise
  Extent force, depth;
  for (std::size_t i = press.first; i <= press.last; ++i) {
    if (!std::isnan(rows[i].force)) force.take(rows[i].force);
    depth.take(rows[i].deflection);
  }
  PressRows piece{press.first, press.first, press.first, press.first, press.first};
  bool pressed = false;
  int low = 0;
  std::size_t out = press.first;
  for (std::size_t i = press.first; i <= press.last; ++i) {
    piece.last = i;
    const double f = rows[i].force;
    if (pressed && f < force.at(kReleased)) {
      if (low == 0 || rows[i].deflection < rows[out].deflection) out = i;
      ++low;
    }
    if (!(f > force.at(kPressed))) continue;
    if (low >= kFew && rows[out].deflection < depth.at(0.5)) {
      piece.last = out;
      pieces.push_back(piece);
      piece = {out + 1, i, i, i, i};
    }
    pressed = true;
    low = 0;
  }
  pieces.push_back(piece);
}

// End of the way in or out: the reading at which the motion turns, seen from the deepest reading.
std::size_t way_end(const std::vector<double>& positions, std::size_t deepest, std::size_t stop,
                    double depth) {
  constexpr double kTurns = 0.2;  // of the depth
  const bool back = stop < deepest;
  std::size_t end = deepest;
  for (std::size_t i = deepest; i != stop; back ? --i : ++i) {
    const std::size_t next = back ? i - 1 : i + 1;
    if (positions[next] > positions[end] + kTurns * depth) break;
    if (positions[next] <= positions[end]) end = next;
  }
  return end;
}

}  // namespace

std::vector<double> without_spikes(std::vector<double> values) {
  double before = values.empty() ? 0.0 : values.front();
  for (std::size_t i = 1; i + 1 < values.size(); ++i) {
    const double own = values[i], after = values[i + 1];
    values[i] = std::clamp(own, std::min(before, after), std::max(before, after));
    before = own;
  }
  return values;
}

double position_noise(std::span<const double> positions) {
  constexpr double kShare = 0.9, kQuantile = 1.6449;  // quantile of the absolute value of a normal number
  std::vector<double> second;
  for (std::size_t i = 2; i < positions.size(); ++i)
    second.push_back(std::abs(positions[i] - 2.0 * positions[i - 1] + positions[i - 2]));
  return second.empty() ? 0.0 : percentile(std::move(second), kShare) / (kQuantile * std::sqrt(6.0));
}

std::vector<PressRows> presses_in(std::span<const LoopRow> rows) {
  std::vector<PressRows> presses;
  for (const PressRows& press : marked(rows)) add_pieces(rows, press, presses);
  std::vector<double> positions;
  positions.reserve(rows.size());
  for (const LoopRow& row : rows) positions.push_back(row.deflection);
  positions = without_spikes(std::move(positions));
  for (PressRows& press : presses) {
    const auto at = [&](std::size_t i) { return positions.begin() + static_cast<std::ptrdiff_t>(i); };
    press.deepest =
        static_cast<std::size_t>(std::max_element(at(press.first), at(press.last + 1)) - positions.begin());
  }
  for (std::size_t k = 0; k < presses.size(); ++k) {
    PressRows& press = presses[k];
    Extent depth;
    for (std::size_t i = press.first; i <= press.last; ++i) depth.take(positions[i]);
    press.from =
        way_end(positions, press.deepest, k > 0 ? presses[k - 1].deepest : 0, depth.at(1.0) - depth.low);
    press.to =
        way_end(positions, press.deepest, k + 1 < presses.size() ? presses[k + 1].deepest : rows.size() - 1,
                depth.at(1.0) - depth.low);
  }
  return presses;
}

namespace {

constexpr std::size_t kBins = 300;  // bins of deflection in a window

// Means of readings with similar deflection.
struct Bin {
  double weight = 0.0, deflection = 0.0, force = 0.0;
};
using Bins = std::vector<Bin>;

double mean_of(const std::vector<double>& x, std::size_t from, std::size_t to) {
  const auto at = [&](std::size_t i) { return x.begin() + static_cast<std::ptrdiff_t>(i); };
  return std::accumulate(at(from), at(to), 0.0) / static_cast<double>(to - from);
}

// Range of readings of an approach: before contact, and in contact up to this share of the force.
std::pair<std::size_t, std::size_t> window_of(const Approach& a, double share) {
  const std::size_t n = a.force.size(), few = std::max<std::size_t>(1, n / 400);
  const double zero = mean_of(a.force, 0, std::max<std::size_t>(few, std::min<std::size_t>(n, 5)));
  const double top = mean_of(a.force, n - few, n);
  std::size_t to = n;
  while (to > few && std::abs(mean_of(a.force, to - few, to) - zero) > share * std::abs(top - zero))
    to -= few;
  // The window extends as far out as to the deepest reading; more would only make the bins coarse.
  const double end = a.deflection[to - 1];
  const double span = *std::max_element(a.deflection.begin(), a.deflection.end()) - end;
  std::size_t from = to;
  while (from > 0 && a.deflection[from - 1] >= end - span) --from;
  return {from, to};
}

Bins bins_of(const Approach& a, double share) {
  const auto [from, to] = window_of(a, share);
  if (to - from < 5) return {};
  const auto at = [&](std::size_t i) { return a.deflection.begin() + static_cast<std::ptrdiff_t>(i); };
  const auto [low, high] = std::minmax_element(at(from), at(to));
  if (!(*high > *low) || !std::isfinite(*high - *low)) return {};
  const std::size_t count = std::min(kBins, to - from);
  Bins bins(count);
  for (std::size_t i = from; i < to; ++i) {
    const double place = (a.deflection[i] - *low) / (*high - *low) * static_cast<double>(count);
    Bin& bin = bins[std::min(count - 1, static_cast<std::size_t>(place))];
    bin.weight += 1.0;
    bin.deflection += a.deflection[i];
    bin.force += a.force[i];
  }
  std::erase_if(bins, [](const Bin& bin) { return bin.weight == 0.0; });
  for (Bin& bin : bins) bin.deflection /= bin.weight, bin.force /= bin.weight;
  return bins;
}

// Sum of squared residuals, N^2, if contact begins at `onset`.
double left_over(std::span<const Bins> all, double onset) {
  Eigen::Matrix2d gram = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  double squares = 0.0;
  for (const Bins& bins : all) {
    double weight = 0.0, force = 0.0;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    const auto powers = [&](const Bin& bin) {
      const double in = std::max(0.0, bin.deflection - onset);
      return Eigen::Vector2d(in, in * in);
    };
    for (const Bin& bin : bins) {
      weight += bin.weight;
      mean += bin.weight * powers(bin);
      force += bin.weight * bin.force;
    }
    mean /= weight, force /= weight;
    for (const Bin& bin : bins) {
      const Eigen::Vector2d x = powers(bin) - mean;
      gram += bin.weight * x * x.transpose();
      right += bin.weight * (bin.force - force) * x;
      squares += bin.weight * (bin.force - force) * (bin.force - force);
    }
  }
  return std::max(0.0, squares - right.dot(gram.ldlt().solve(right)));
}

struct Candidate {
  double at = kUnset, error = kUnset;  // m
  double reach = kUnset;               // m, from `at` to the deepest reading of the window
};

// The onset with the least sum, first on a coarse grid and then on two fine ones. The curvature of the sum
// gives the error.
Candidate candidate_of(std::span<const Approach> approaches, double share) {
  std::vector<Bins> all;
  double low = INFINITY, high = -INFINITY, count = 0.0;
  for (const Approach& a : approaches) {
    Bins bins = bins_of(a, share);
    if (bins.empty()) continue;
    low = std::min(low, bins.front().deflection), high = std::max(high, bins.back().deflection);
    count += static_cast<double>(bins.size());
    all.push_back(std::move(bins));
  }
  if (all.empty() || !(high > low)) return {};
  constexpr int kSteps = 100;
  double from = low + 0.02 * (high - low), to = high - 0.05 * (high - low), step = 0.0, least = INFINITY,
         best = kUnset;
  for (int zoom = 0; zoom < 3; ++zoom) {
    step = (to - from) / kSteps;
    for (int i = 0; i <= kSteps; ++i) {
      const double here = from + i * step, sum = left_over(all, here);
      if (sum < least) least = sum, best = here;
    }
    if (zoom == 0 && (best <= low + 0.03 * (high - low))) return {};  // the approaches begin in contact
    from = best - 2.0 * step, to = best + 2.0 * step;
  }
  const double variance = least / std::max(1.0, count - static_cast<double>(all.size()) - 3.0);
  const double wide = 1e-3 * (high - low);  // over several bins, because a sum over bins has kinks
  const double bend =
      (left_over(all, best - wide) + left_over(all, best + wide) - 2.0 * least) / (wide * wide);
  return {best, bend > 0.0 ? std::sqrt(2.0 * variance / bend) : variance > 0.0 ? kUnset : 0.0, high - best};
}

}  // namespace

Onset find_onset(std::span<const Approach> approaches) {
  constexpr std::array<double, 3> kShares{0.30, 0.15, 0.07};
  constexpr double kAgree = 2.5;         // standard deviations
  constexpr double kLeastBefore = 0.04;  // least share of the depth before contact
  constexpr double kChance = 0.5;        // share of the windows' range, if they differ by chance alone
  constexpr double kUnsure = 0.01;       // share of the depth, for a curve that only one window shows
  // Share of the smallest window that is added to the error if the curve begins softly. The nominal ball
  // (felt, friction) is found 0.30 mm too late at 20 mm/s, 0.45 of that window: 1.8 standard deviations of
  // this error.
  constexpr double kSoft = 0.25;
  std::array<Candidate, kShares.size()> found;
  for (std::size_t i = 0; i < kShares.size(); ++i) found[i] = candidate_of(approaches, kShares[i]);
  const auto apart = [&](std::size_t i, std::size_t j) { return std::abs(found[i].at - found[j].at); };
  const auto agree = [&](std::size_t i, std::size_t j) {
    return apart(i, j) <= kAgree * std::hypot(found[i].error, found[j].error) + 1e-6;
  };
  double outermost = INFINITY, deepest = -INFINITY;
  for (const Approach& a : approaches)
    for (const double d : a.deflection) outermost = std::min(outermost, d), deepest = std::max(deepest, d);
  const auto known = [&](std::size_t i) { return !std::isnan(found[i].at) && !std::isnan(found[i].error); };
  Onset onset;
  double low = INFINITY, high = -INFINITY;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (known(i)) low = std::min(low, found[i].at), high = std::max(high, found[i].at);
  if (agree(0, 1) && agree(0, 2))
    onset = {found[0].at, std::hypot(found[0].error, kChance * (high - low))};
  else if (known(1) && known(2)) {
    // Each smaller window finds an earlier onset, so a still smaller one may find an even earlier one.
    const bool soft = known(0) && found[0].at > found[1].at && found[1].at > found[2].at;
    onset = {found[2].at,
             std::hypot(found[2].error, std::max(high - low, soft ? kSoft * found[2].reach : 0.0))};
  } else if (const std::size_t i = known(1) ? 1 : 0; known(i))  // too few readings for a smaller window
    onset = {found[i].at, std::hypot(found[i].error, kUnsure * (deepest - found[i].at))};
  if (!onset.known()) return {};
  return onset.at - outermost >= kLeastBefore * (deepest - onset.at) ? onset : Onset{};
}

namespace {

constexpr double kLeast = 1e-3;  // share of the force's rise, of the depth: least correction
// A zero that changes by more than this share of the rise bends the curve.
constexpr double kOtherForce = 0.05;

class ContactFinder {
 public:
  ContactFinder(std::span<const LoopRow> rows, std::span<const PressRows> presses)
      : rows_(rows), presses_(presses) {
    std::vector<double> positions;
    for (const PressRows& press : presses)
      for (std::size_t i = press.first; i <= press.last; ++i) positions.push_back(rows[i].deflection);
    noise_ = position_noise(positions);
    contact_.zeros.resize(presses.size());
  }

  Contact find() {
    // The onset needs no zero, but one that drifts within a press bends the curve.
    for (int pass = 0; pass < 2; ++pass) {
      contact_.onset = find_onset(approaches());
      take_zeros();
    }
    judge();
    fill();
    return std::move(contact_);
  }

 private:
  std::vector<Approach> approaches() const {
    std::vector<Approach> all;
    for (std::size_t k = 0; k < presses_.size(); ++k) {
      Approach a;
      for (std::size_t i = presses_[k].from; i <= presses_[k].deepest; ++i) {
        if (std::isnan(rows_[i].force)) continue;
        a.deflection.push_back(rows_[i].deflection);
        a.force.push_back(rows_[i].force - contact_.zeros[k].at(rows_[i].time));
      }
      if (a.force.size() > 1) all.push_back(std::move(a));
    }
    return all;
  }

  double begin() const { return contact_.onset.known() ? contact_.onset.at : 0.0; }
  double depth(const PressRows& press) const { return rows_[press.deepest].deflection - begin(); }

  // Zero from the rows of a way without contact. It leaves out the rows at rest farthest out if enough others
  // remain, because a rig may tare again there.
  ForceZero zero_of(const PressRows& press, std::size_t from, std::size_t to) const {
    constexpr double kOutside = 0.02;  // of the depth
    constexpr std::size_t kEnough = 20;
    const double spare = std::max(8.0 * noise_, kOutside * depth(press));
    const double unsure = contact_.onset.known() ? 2.0 * contact_.onset.error : 0.0;
    const double most = begin() - std::max(spare, unsure);
    double outermost = INFINITY;
    std::vector<std::size_t> free;
    for (std::size_t i = from; i <= to; ++i) {
      const LoopRow& row = rows_[i];
      const bool told = row.repeat == 0 && row.deflection <= std::min(0.0, begin());
      if (std::isnan(row.force) || !(row.deflection <= most || told)) continue;
      if (row.deflection < begin() - 0.5 * depth(press)) continue;
      outermost = std::min(outermost, row.deflection);
      free.push_back(i);
    }
    std::vector<std::size_t> moving = free;
    std::erase_if(moving, [&](std::size_t i) { return rows_[i].deflection <= outermost + spare; });
    return mean_of_rows(moving.size() >= kEnough ? moving : free);
  }

  ForceZero mean_of_rows(const std::vector<std::size_t>& which) const {
    constexpr std::size_t kEnoughRows = 10;
    if (which.size() < kEnoughRows) return {};
    const auto n = static_cast<double>(which.size());
    ForceZero zero{0.0, 0.0, 0.0};
    for (const std::size_t i : which) zero.time += rows_[i].time / n, zero.force += rows_[i].force / n;
    double tt = 0.0, tf = 0.0, ff = 0.0;
    for (const std::size_t i : which) {
      const double t = rows_[i].time - zero.time, f = rows_[i].force - zero.force;
      tt += t * t, tf += t * f, ff += f * f;
    }
    zero.error = std::sqrt(ff / (n - 1.0) / n);
    zero.rate = tf / tt;
    zero.rate_error = std::sqrt(std::max(0.0, ff - tf * zero.rate) / (n - 2.0) / tt);
    return std::isfinite(zero.time) && std::isfinite(zero.force) && std::isfinite(zero.error) ? zero
                                                                                              : ForceZero{};
  }

  double rise_of(std::size_t press) const {
    return std::abs(rows_[presses_[press].deepest].force - contact_.zeros[press].before.force);
  }

  void take_zeros() {
    for (std::size_t k = 0; k < presses_.size(); ++k) {
      const PressRows& press = presses_[k];
      contact_.zeros[k] = {zero_of(press, press.from, press.deepest),
                           zero_of(press, press.deepest, press.to)};
    }
    find_drift();
  }

  // The force after a press is a zero if it equals the one before, or if a drift connects both. Otherwise it
  // is another force, such as adhesion.
  void find_drift() {
    contact_.drift = 0.0, contact_.other_press = 0, contact_.untold_drift = false;
    const std::vector<PressZero> found = contact_.zeros;
    for (std::size_t k = 0; k < found.size(); ++k) {
      const auto& [before, after] = found[k];
      if (!before.known()) continue;
      const double most = kOtherForce * rise_of(k);
      const ForceZero next = k + 1 < found.size() ? found[k + 1].before : ForceZero{};
      if (!after.known()) {
        contact_.untold_drift = contact_.untold_drift || std::abs(next.force - before.force) > most ||
                                leads_away(before, k, most);
        continue;
      }
      const double moved = after.force - before.force;
      if (!(std::abs(moved) > most)) continue;
      if (drifts(found, k)) {
        const double rate = moved / (after.time - before.time);
        if (std::abs(rate) > std::abs(contact_.drift)) contact_.drift = rate;
        continue;
      }
      contact_.zeros[k].after = {};
      if (contact_.other_press == 0) contact_.other_press = k + 1, contact_.other_force = moved;
    }
    // A detected drift continues in presses without rows after them, and no correction removes it there.
    const auto open = [](const PressZero& zero) { return zero.before.known() && !zero.after.known(); };
    if (contact_.drift != 0.0 && std::any_of(found.begin(), found.end(), open)) contact_.untold_drift = true;
  }

  // True if the zero moves so fast before the press that it differs at the deepest reading.
  [[nodiscard]] bool leads_away(const ForceZero& before, std::size_t k, double most) const {
    constexpr double kSure = 0.25;  // of the change
    const double lasts = rows_[presses_[k].deepest].time - before.time;
    const double moved = std::abs(before.rate) * lasts;
    return moved > most && before.rate_error * lasts <= kSure * moved;
  }

  // The zero's change on the way to the press, and from one press to the next, reveals a drift.
  static bool drifts(std::span<const PressZero> zeros, std::size_t k) {
    // The rate must be known to the first share of the change, and must agree with it within the second.
    constexpr double kSure = 0.25, kLike = 0.5;
    const ForceZero &before = zeros[k].before, &after = zeros[k].after;
    const double lasts = after.time - before.time, moved = after.force - before.force;
    const auto explains = [&](double rate, double error) {
      return error * lasts <= kSure * std::abs(moved) &&
             std::abs(rate * lasts - moved) <= kLike * std::abs(moved);
    };
    const auto from_to = [&](const ForceZero& a, const ForceZero& b) {
      const double apart = b.time - a.time;
      return explains((b.force - a.force) / apart, std::hypot(a.error, b.error) / apart);
    };
    return explains(before.rate, before.rate_error) ||
           (k + 1 < zeros.size() && from_to(before, zeros[k + 1].before)) ||
           (k > 0 && from_to(zeros[k - 1].before, before));
  }

  void judge() {
    constexpr double kBeyondChance = 4.0;  // standard deviations
    for (std::size_t k = 0; k < presses_.size(); ++k) {
      const LoopRow& deepest = rows_[presses_[k].deepest];
      const PressZero& zero = contact_.zeros[k];
      for (const ForceZero& one : {zero.before, zero.after})
        if (std::abs(one.force) >
            std::max(kBeyondChance * one.error, kLeast * std::abs(deepest.force - zero.at(deepest.time))))
          contact_.subtract = true;
      contact_.shift = contact_.shift || (contact_.onset.known() &&
                                          std::abs(begin()) > std::max(kBeyondChance * contact_.onset.error,
                                                                       kLeast * depth(presses_[k])));
    }
  }

  // A press without a zero of its own takes that of the nearest press in time.
  void fill() {
    const std::vector<PressZero> own = contact_.zeros;
    for (std::size_t k = 0; k < own.size(); ++k) {
      if (own[k].known()) continue;
      double nearest = INFINITY;
      for (std::size_t j = 0; j < own.size(); ++j)
        for (const ForceZero& one : {own[j].before, own[j].after}) {
          const double away = std::abs(one.time - rows_[presses_[k].deepest].time);
          if (away < nearest) nearest = away, contact_.zeros[k] = {one, {}};
        }
    }
  }

  std::span<const LoopRow> rows_;
  std::span<const PressRows> presses_;
  double noise_ = 0.0;  // m
  Contact contact_;
};

}  // namespace

double PressZero::at(double time) const {
  if (!before.known()) return after.known() ? after.force : 0.0;
  if (!after.known() || !(after.time > before.time)) return before.force;
  const double share = (time - before.time) / (after.time - before.time);
  return before.force + share * (after.force - before.force);
}

double PressZero::error() const {
  return std::fmax(std::isnan(before.error) ? 0.0 : before.error,
                   std::isnan(after.error) ? 0.0 : after.error);
}

double Contact::zero_error() const {
  double squares = 0.0;
  for (const PressZero& zero : zeros) squares += zero.error() * zero.error();
  return subtract ? std::sqrt(squares) / static_cast<double>(zeros.size()) : 0.0;
}

std::vector<std::string> Contact::notes() const {
  std::vector<std::string> notes;
  double least = INFINITY, most = -INFINITY;
  bool all_before = true;
  for (const PressZero& zero : zeros) {
    if (!zero.known()) continue;
    const ForceZero& one = zero.before.known() ? zero.before : zero.after;
    least = std::min(least, one.force), most = std::max(most, one.force);
    all_before = all_before && zero.before.known();
  }
  const std::string of = most - least < 0.01 ? fmt::format("{:.2f} N", 0.5 * (least + most))
                                             : fmt::format("{:.2f} to {:.2f} N", least, most);
  if (subtract)
    notes.push_back(
        fmt::format("{} contact the force is {}: subtracted", all_before ? "before" : "outside of", of));
  if (shift) notes.push_back(fmt::format("contact begins at {:.2f} mm: shifted", onset.at * 1e3));
  if (drift != 0.0)
    notes.push_back(fmt::format(
        "the zero of the force drifts by {:.2g} N/s: taken for a straight line in time from before "
        "each press to after it",
        drift));
  if (other_press > 0)
    notes.push_back(fmt::format(
        "after press {} the force is {:.2f} N, against the zero before it: what clings to the probe, or a "
        "zero "
        "that moved; only the one before is subtracted, so the curves may be off by as much; record on "
        "until the force is at rest, far outside",
        other_press, other_force));
  if (untold_drift)
    notes.push_back(
        "the zero of the force moves from press to press, and no reading after a press tells by how much "
        "within one: the curves may be off by as much; record until after contact");
  return notes;
}

Contact find_contact(std::span<const LoopRow> rows, std::span<const PressRows> presses) {
  return ContactFinder(rows, presses).find();
}

}  // namespace enc::models
