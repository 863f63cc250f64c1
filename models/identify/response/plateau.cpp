#include "models/identify/response/plateau.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "models/identify/response/loop_rows.h"

namespace enc::models {
namespace {

// The grain of a force, N: its noise from reading to reading, or its steps where these are larger.
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

}  // namespace

Plateau plateau_of(std::span<const LoopPoint> moving) {
  // A plateau begins so many grains below the largest force.
  constexpr double kNear = 4.0;
  // The force rises over it by less grains than this, and by less than this share of the rise over as long a
  // way before it.
  constexpr double kFlat = 2.0, kShare = 0.25;
  // It is longer than this share of the depth.
  constexpr double kLeast = 0.02;
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
  if (!(way > kLeast * deepest)) return {};
  const double rise = rise_between(moving, flat.from, deepest);
  return rise < kFlat * grain && rise < kShare * rise_between(moving, flat.from - way, flat.from) ? flat
                                                                                                  : Plateau{};
}

}  // namespace enc::models
