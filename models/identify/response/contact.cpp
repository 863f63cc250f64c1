#include "models/identify/response/contact.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

namespace enc::models {
namespace {

constexpr double kLeast = 1e-3;  // of the force's rise, of the depth: less is not worth a correction
// A zero that differs by more than this share of the rise bends the curve.
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

  // Rows of a way on which nothing touches, without those where it rests farthest out if enough remain: there
  // a rig may take its zero anew.
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

  // The zero after a press is one where it is like that before, or where a drift leads from the one to the
  // other. Else it is another force, such as adhesion.
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
    // A drift that was found goes on in presses without rows after them, where nothing subtracts it.
    const auto open = [](const PressZero& zero) { return zero.before.known() && !zero.after.known(); };
    if (contact_.drift != 0.0 && std::any_of(found.begin(), found.end(), open)) contact_.untold_drift = true;
  }

  // The zero moves before the press so fast that it is another one at its deepest reading.
  [[nodiscard]] bool leads_away(const ForceZero& before, std::size_t k, double most) const {
    constexpr double kSure = 0.25;  // of the change
    const double lasts = rows_[presses_[k].deepest].time - before.time;
    const double moved = std::abs(before.rate) * lasts;
    return moved > most && before.rate_error * lasts <= kSure * moved;
  }

  // What the zero does on the way to the press, and from one press to the next, tells a drift.
  static bool drifts(std::span<const PressZero> zeros, std::size_t k) {
    // A rate has to be known to the first share of the change, and to be like it within the second.
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

  // A press that has no zero of its own has that of the nearest one in time.
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
