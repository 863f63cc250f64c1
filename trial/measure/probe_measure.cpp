#include "trial/measure/probe_measure.h"

#include <algorithm>
#include <cmath>

namespace enc::trial {

void ProbeMeasure::Range::add(double force) {
  low = pushes == 0 ? force : std::min(low, force);
  high = pushes == 0 ? force : std::max(high, force);
  ++pushes;
}

// The levels between the last tick and this one, by straight interpolation.
void ProbeMeasure::compare(double deflection, double force) {
  if (deflection == deflection_) return;
  std::vector<Range>& ranges = levels_[deflection > deflection_ ? 0 : 1];
  const auto [from, to] = std::minmax(deflection_, deflection);
  const auto last = static_cast<std::size_t>(std::floor(std::max(0.0, to) / kLevel));
  for (auto i = static_cast<std::size_t>(std::ceil(std::max(0.0, from) / kLevel)); i <= last; ++i) {
    const double level = static_cast<double>(i) * kLevel;
    if (level <= 0.0 || level < from || level >= to) continue;
    if (ranges.size() <= i) ranges.resize(i + 1);
    ranges[i].add(force_ + (force - force_) * (level - deflection_) / (deflection - deflection_));
  }
}

void ProbeMeasure::see(const Glance& glance) {
  if (glance.out.mode != Mode::probe || glance.out.contacts == 0 || !glance.out.felt.finite()) return;
  const Vec<'W'> axis = glance.scene.probe()->X_WN * Vec<'N'>(0, 0, 1);
  const double force = dot(glance.out.felt, axis);
  const double deflection = glance.out.deflection;
  if (pushes_.size() != static_cast<std::size_t>(glance.out.contacts)) {
    pushes_.resize(static_cast<std::size_t>(glance.out.contacts));
    deflection_ = kUnset;
  }
  PushFigures& push = pushes_.back();
  if (deflection > 0.0) {
    push.peak_force = std::max(push.peak_force, force);
    push.peak_deflection = std::max(push.peak_deflection, deflection);
    force_error_ = std::max(force_error_, std::abs(force - dot(glance.truth.contact_force, axis)));
    if (!std::isnan(deflection_)) {
      const double way = deflection - std::max(0.0, deflection_);
      (way > 0.0 ? push.work_in : push.work_out) += 0.5 * (force + force_) * std::abs(way);
    }
  }
  if (!std::isnan(deflection_)) compare(deflection, force);
  deflection_ = deflection;
  force_ = force;
}

double ProbeMeasure::spread() const {
  double most = kUnset;
  for (const std::vector<Range>& ranges : levels_)
    for (const Range& range : ranges)
      if (range.pushes > 1) most = std::fmax(most, range.high - range.low);
  return most;
}

}  // namespace enc::trial
