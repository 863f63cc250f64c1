#include "core/dent.h"

#include <algorithm>
#include <cmath>

namespace enc {
namespace {

// How far the dent reaches sideways, m. A thin ball dimples over sqrt(R depth) [parameters 4.2, Pogorelov]; a
// half space over a few depths; both wrap the tip itself.
double width(const Surface& surface, const DentSample& dent) {
  const auto* sphere = std::get_if<Sphere>(&surface.shape());
  const double reach = sphere != nullptr ? std::sqrt(sphere->radius * dent.depth) : 4.0 * dent.depth;
  return dent.tip_radius + reach;
}

}  // namespace

DentSample dent_of(const Surface& surface, std::int32_t object, const Point<'O'>& tip,
                   double tip_radius) noexcept {
  return {object, tip, tip_radius, std::max(0.0, tip_radius - surface.nearest(tip).distance)};
}

double dented_distance(const Surface& surface, const DentSample& dent, const Point<'O'>& p) noexcept {
  const Nearest at = surface.nearest(p);
  if (!(dent.depth > 0.0)) return at.distance;
  const double beside =
      (at.point - surface.nearest(dent.tip).point).norm() / std::max(width(surface, dent), 1e-9);
  return at.distance + dent.depth * std::exp(-beside * beside);
}

}  // namespace enc
