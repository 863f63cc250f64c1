#include "models/fit/loop/contact.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

namespace enc::models {
namespace {

constexpr double kLeast = 1e-3;  // of the force's rise, of the depth: less is not worth a correction

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
    for (const std::size_t i : which) zero.error += std::pow(rows_[i].force - zero.force, 2);
    zero.error = std::sqrt(zero.error / (n - 1.0) / n);
    return std::isfinite(zero.time) && std::isfinite(zero.force) && std::isfinite(zero.error) ? zero
                                                                                              : ForceZero{};
  }

  void take_zeros() {
    constexpr double kOtherForce = 0.05;  // of the rise: what differs by more is no zero, such as adhesion
    for (std::size_t k = 0; k < presses_.size(); ++k) {
      const PressRows& press = presses_[k];
      PressZero& zero = contact_.zeros[k];
      zero = {zero_of(press, press.from, press.deepest), zero_of(press, press.deepest, press.to)};
      if (!zero.before.known() || !zero.after.known()) continue;
      const double rise = std::abs(rows_[press.deepest].force - zero.before.force);
      if (std::abs(zero.after.force - zero.before.force) > kOtherForce * rise) zero.after = {};
    }
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
  return notes;
}

Contact find_contact(std::span<const LoopRow> rows, std::span<const PressRows> presses) {
  return ContactFinder(rows, presses).find();
}

}  // namespace enc::models
