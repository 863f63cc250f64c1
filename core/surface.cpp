#include "core/surface.h"

#include <limits>

#include "core/mesh/mesh_tree.h"

namespace enc {
namespace {

Nearest nearest_on(const Plane&, const Point<'O'>& p) {
  return {Point<'O'>(p.xyz[0], p.xyz[1], 0.0), Vec<'O'>(0, 0, 1), p.xyz[2], -1};
}

Nearest nearest_on(const Sphere& sphere, const Point<'O'>& p) {
  const double r = p.e().norm();
  const Vec3 n = r > 1e-12 ? Vec3(p.e() / r) : Vec3(0, 0, 1);
  return {Point<'O'>(Vec3(sphere.radius * n)), Vec<'O'>(n), r - sphere.radius, -1};
}

}  // namespace

Nearest Surface::nearest(const Point<'O'>& p, std::int32_t hint) const noexcept {
  if (const auto* sphere = std::get_if<Sphere>(&shape_)) return nearest_on(*sphere, p);
  if (const auto* mesh = std::get_if<MeshSurface>(&shape_)) return mesh->tree->nearest(p, hint);
  return nearest_on(Plane{}, p);
}

Ball Surface::bound() const noexcept {
  if (const auto* sphere = std::get_if<Sphere>(&shape_)) return {Point<'O'>(0, 0, 0), sphere->radius};
  if (const auto* mesh = std::get_if<MeshSurface>(&shape_)) return mesh->tree->bound();
  return {Point<'O'>(0, 0, 0), std::numeric_limits<double>::infinity()};
}

}  // namespace enc
