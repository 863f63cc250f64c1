#include "core/shape/surface/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/shape/surface/mesh_tree.h"

namespace enc {
namespace {

SurfacePoint nearest_on(const Plane&, const Point<'O'>& p) {
  return {Point<'O'>(p.xyz[0], p.xyz[1], 0.0), Vec<'O'>(0, 0, 1), p.xyz[2], -1};
}

SurfacePoint nearest_on(const Sphere& sphere, const Point<'O'>& p) {
  const double r = p.e().norm();
  const Vec3 n = r > 1e-12 ? Vec3(p.e() / r) : Vec3(0, 0, 1);
  return {Point<'O'>(Vec3(sphere.radius * n)), Vec<'O'>(n), r - sphere.radius, -1};
}

Point<'O'> into_box(const Button& b, const Point<'O'>& p) {
  const double w = 0.5 * b.width, h = 0.5 * b.height;
  return {std::clamp(p.xyz[0], -w, w), std::clamp(p.xyz[1], -h, h), std::clamp(p.xyz[2], -b.thickness, 0.0)};
}

SurfacePoint nearest_on(const Button& button, const Point<'O'>& p) {
  constexpr double kRounding = 1e-12;  // m; a point this close to the edge counts as over the face
  const Point<'O'> at = into_box(button, p);
  const Vec<'O'> away = p - at;
  const double beside = std::max(std::abs(away.xyz[0]), std::abs(away.xyz[1]));
  if (beside <= kRounding && away.xyz[2] >= -kRounding)
    return {Point<'O'>(at.xyz[0], at.xyz[1], 0.0), Vec<'O'>(0, 0, 1), p.xyz[2], kButtonFace};
  const double distance = away.norm();
  return {at, (1.0 / distance) * away, distance, kButtonSide};
}

}  // namespace

SurfacePoint Surface::nearest(const Point<'O'>& p, std::int32_t hint) const noexcept {
  if (const auto* sphere = std::get_if<Sphere>(&shape_)) return nearest_on(*sphere, p);
  if (const auto* mesh = std::get_if<MeshSurface>(&shape_)) return mesh->tree->nearest(p, hint);
  if (const auto* button = std::get_if<Button>(&shape_)) return nearest_on(*button, p);
  return nearest_on(Plane{}, p);
}

Point<'O'> Surface::over_face(const Point<'O'>& p, double margin) const noexcept {
  const auto* button = std::get_if<Button>(&shape_);
  if (button == nullptr) return p;
  const Point<'O'> inside = into_box(*button, p);
  const double x = p.xyz[0] - inside.xyz[0], y = p.xyz[1] - inside.xyz[1];
  return std::hypot(x, y) <= margin ? Point<'O'>(inside.xyz[0], inside.xyz[1], p.xyz[2]) : p;
}

Ball Surface::bound() const noexcept {
  if (const auto* sphere = std::get_if<Sphere>(&shape_)) return {Point<'O'>(0, 0, 0), sphere->radius};
  if (const auto* mesh = std::get_if<MeshSurface>(&shape_)) return mesh->tree->bound();
  // Inside, the distance is the one to the face. It reaches down to -thickness at each corner of the bottom.
  if (const auto* button = std::get_if<Button>(&shape_))
    return {Point<'O'>(0, 0, -button->thickness),
            0.5 * std::hypot(button->width, button->height) + button->thickness};
  return {Point<'O'>(0, 0, 0), std::numeric_limits<double>::infinity()};
}

}  // namespace enc
