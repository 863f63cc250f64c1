#include "core/shape/deformation/dent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/shape/deformation/dent_field.h"

namespace enc {
namespace {

// How far the contact sinks with the ball itself, and how far around that is seen: shares of the ball's
// radius. Calibrated at 2 and 6 mm on a pressed tennis ball [docs/notes/deformation.md]: at first the felt
// gives way, then the wall. A half space does not sink.
constexpr double kStiff = 0.116;
constexpr double kSinking = 0.80;

// The slope at which the surface leaves the tip: twice the slope sqrt(d/R) at the rim of the dimple of a thin
// ball [sources/ball 2, Pogorelov]. A half space dents over a few depths: 10/3 d.
double leaving_slope(double size, double depth, const DentSample& dent, const Vec3& n) {
  const double own = std::isfinite(size) ? 2.0 * std::sqrt(depth / size) : 0.75;
  if (dent.tip.shape != TipShape::cone) return own;
  // No steeper than the flattest line on the cone's side; a cone that nearly lies on its side is cut short.
  const double tilt = std::acos(std::clamp(dent.tip.axis.e().dot(n), -1.0, 1.0));
  const double flank = 0.5 * std::numbers::pi - (dent.tip.half_angle + tilt);
  return std::min(own, std::tan(std::max(flank, 0.1)));
}

// The rest of the edge, seen from its deepest ball. Where it rises faster than the surface leaves it, only
// that ball counts.
void sweep(DentField<double>& field, const Tip<'O'>& tip, const Vec3& centre, const Vec3& n) {
  const double at = tip.axis.e().dot(centre - tip.centre.e());
  const double up = tip.axis.e().dot(n);
  const Vec3 side = tip.axis.e() - up * n;
  const double flat = side.norm();
  if (std::abs(up) >= field.slope * flat * (1.0 - 1e-6)) return;
  // Along the edge towards its rising end; level edges go both ways.
  const double sign = up < 0.0 ? -1.0 : 1.0;
  const bool level = std::abs(up) < 1e-5;
  field.edge = true;
  Vec3::Map(field.along.data()) = sign * side / flat;
  field.to = std::max(0.0, flat * (0.5 * tip.length - sign * at));
  field.from = level ? std::min(0.0, -flat * (0.5 * tip.length + sign * at)) : 0.0;
  field.rise = level ? 0.0 : std::abs(up) / flat;
  field.lean = level ? 0.0 : std::abs(up);
  field.lean_cone = field.rise / std::sqrt(field.slope * field.slope - field.rise * field.rise);
  field.reach += field.slope * std::max(field.to, -field.from);
}

Vec3 vec(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

detail::Shift<double> shift_at(const DentField<double>& field, const Point<'O'>& p) {
  if (!field.active) return {};
  return field.edge ? detail::shift<true>(field, p.xyz[0], p.xyz[1], p.xyz[2])
                    : detail::shift<false>(field, p.xyz[0], p.xyz[1], p.xyz[2]);
}

// The undeformed surface above or below p along n: Newton steps on the distance. False where there is none,
// or where it turns away from n.
bool surface_over(const Surface& surface, const Vec3& n, const Point<'O'>& p, Nearest at, double& up) {
  constexpr double kFlat = 0.2;
  up = 0.0;
  for (int i = 0; i < 12; ++i) {
    const double slope = at.normal.e().dot(n);
    if (slope < kFlat) return false;
    up -= at.distance / slope;
    at = surface.nearest(p + up * Vec<'O'>(n), at.feature);
    if (std::abs(at.distance) < 1e-10) return at.normal.e().dot(n) >= kFlat;
  }
  return false;
}

}  // namespace

Deepest deepest(const Surface& surface, const Tip<'O'>& tip, std::int32_t hint) noexcept {
  Deepest found{tip.centre, surface.nearest(tip.centre, hint)};
  if (tip.shape != TipShape::edge) return found;
  // The distance along the edge is least where the normal stands across it: secant steps kept in the bracket.
  const auto slope = [&] { return found.at.normal.e().dot(tip.axis.e()); };
  const auto go = [&](double s) {
    found.centre = tip.centre + s * tip.axis;
    found.at = surface.nearest(found.centre, found.at.feature);
    return slope();
  };
  constexpr double kLevel = 1e-7;
  if (std::abs(slope()) < kLevel) return found;
  double s0 = slope() > 0.0 ? -0.5 * tip.length : 0.0;
  double s1 = s0 + 0.5 * tip.length;
  double g1 = s0 < 0.0 ? slope() : go(s1);
  if (g1 <= 0.0) return found;  // still falling at the far end
  double g0 = s0 < 0.0 ? go(s0) : 0.0;
  if (s0 < 0.0 && g0 >= 0.0) return found;
  if (!(s0 < 0.0)) g0 = go(s0);
  for (int i = 0; i < 40; ++i) {
    const double s = std::clamp((s0 * g1 - s1 * g0) / (g1 - g0), s0, s1);
    const double g = go(i % 3 == 2 ? 0.5 * (s0 + s1) : s);
    const double here = (found.centre - tip.centre).e().dot(tip.axis.e());
    if (std::abs(g) < kLevel || s1 - s0 < 1e-9) break;
    (g > 0.0 ? s1 : s0) = here;
    (g > 0.0 ? g1 : g0) = g;
  }
  return found;
}

DentSample dent_of(const Surface& surface, std::int32_t object, const Tip<'O'>& tip) noexcept {
  return {object, tip, std::max(0.0, tip.radius - deepest(surface, tip).at.distance)};
}

DentField<double> dent_field(const Surface& surface, const DentSample& dent, std::int32_t hint) noexcept {
  constexpr double kPoint =
      0.2e-3;  // m: a sharper tip is drawn as round as this, its lowest point in its place
  DentField<double> field;
  if (!(dent.depth > 0.0)) return field;
  const Deepest at = deepest(surface, dent.tip, hint);
  const Vec3 n = at.at.normal.e();
  field.active = true;
  Vec3::Map(field.n.data()) = n;
  Vec3::Map(field.origin.data()) = at.centre.e() - dent.tip.radius * n;
  Vec3::Map(field.contact.data()) = at.centre.e() - (dent.tip.radius - dent.depth) * n;
  field.depth = dent.depth;
  const double size = surface.bound().radius;
  if (std::isfinite(size)) {
    field.sink = dent.depth * dent.depth / (dent.depth + kStiff * size);
    field.narrow = 1.0 / (kSinking * size * kSinking * size);
  }
  field.blend = 0.5 * (dent.depth - field.sink);
  field.radius = std::max(dent.tip.radius, kPoint);
  field.slope = leaving_slope(size, dent.depth, dent, n);
  const double cosine = 1.0 / std::sqrt(1.0 + field.slope * field.slope);
  const double cap = field.radius * field.slope * cosine;
  field.cap2 = cap * cap;
  field.cone = field.radius * (1.0 - 1.0 / cosine);
  field.reach = 3.0 * field.blend - field.cone;
  if (dent.tip.shape == TipShape::edge) sweep(field, dent.tip, at.centre.e(), n);
  return field;
}

Displaced displaced(const DentField<double>& field, const Point<'O'>& p, const Vec<'O'>& normal) noexcept {
  const auto shift = shift_at(field, p);
  if (!(shift.by > 0.0)) return {p, normal, 0.0};
  // x -> x - n by(x) has the gradient I - n g^T; normals go with its inverse transpose.
  const Vec3 n = vec(field.n);
  const Vec3 g(shift.gx, shift.gy, shift.gz);
  const Vec3 turned = (1.0 - g.dot(n)) * normal.e() + normal.e().dot(n) * g;
  return {p - shift.by * Vec<'O'>(n), Vec<'O'>(turned.normalized()), shift.by};
}

double dented_distance(const Surface& surface, const DentSample& dent, const Point<'O'>& p,
                       std::int32_t hint) noexcept {
  const Nearest at = surface.nearest(p, hint);
  const DentField<double> field = dent_field(surface, dent, at.feature);
  if (!field.active) return at.distance;
  const Vec3 n = vec(field.n);
  const Vec3 from_tip = p.e() - vec(field.origin);
  const double aside = (from_tip - from_tip.dot(n) * n).norm();
  const bool on_tip = field.slope * aside < 2.0 * field.depth + field.reach;
  const bool sunk = field.sink > 0.0 && aside * aside * field.narrow < 1.0;
  if (!on_tip && !sunk) return at.distance;
  double up = 0.0;
  if (!surface_over(surface, n, p, at, up)) return at.distance;
  const Point<'O'> top = p + up * Vec<'O'>(n);
  const Displaced seen = displaced(field, top, surface.nearest(top, at.feature).normal);
  return seen.by > 0.0 ? (seen.by - up) * seen.normal.e().dot(n) : at.distance;
}

double volume_change(const Mesh& mesh, const DentField<double>& field) {
  double six = 0.0;
  for (const auto& triangle : mesh.triangles) {
    Mat3 before;
    Mat3 after;
    for (int i = 0; i < 3; ++i) {
      const Vec3 p = vec(mesh.vertices[static_cast<std::size_t>(triangle[static_cast<std::size_t>(i)])]);
      before.col(i) = p;
      after.col(i) = p - shift_at(field, Point<'O'>(p)).by * vec(field.n);
    }
    if (after != before) six += after.determinant() - before.determinant();
  }
  return six / 6.0;
}

}  // namespace enc
