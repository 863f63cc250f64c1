// The point of a triangle that is nearest to p, in double. Slivers need no special case, because no step
// divides by an area.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/base/frames.h"

namespace enc {

[[nodiscard]] inline Vec3 vec(const std::array<double, 3>& a) noexcept { return {a[0], a[1], a[2]}; }

// Part of a triangle: its corner i, its edge from corner i to corner i + 1, or its inside.
struct Part {
  enum Kind : std::uint8_t { face, edge, corner };
  Kind kind = face;
  std::uint8_t i = 0;
};
struct OnTriangle {
  Vec3 point;
  double square = 0.0;  // squared distance, m^2
  Part part;
};

// Corners counter-clockwise seen from outside. `ids` name the corners: an edge is computed from its lower to
// its higher id, so that both its triangles give the same bits.
inline OnTriangle nearest_on_triangle(const Vec3& p, const std::array<Vec3, 3>& corner,
                                      const std::array<std::int32_t, 3>& ids) {
  const std::array<Vec3, 3> side{corner[1] - corner[0], corner[2] - corner[1], corner[0] - corner[2]};
  const std::array<Vec3, 3> way{p - corner[0], p - corner[1], p - corner[2]};
  const Vec3 normal = side[0].cross(side[1]);
  // A point exactly on an edge counts as on the edge, which has its own normal.
  const bool inside = normal.dot(side[0].cross(way[0])) > 0.0 && normal.dot(side[1].cross(way[1])) > 0.0 &&
                      normal.dot(side[2].cross(way[2])) > 0.0;
  if (inside) {
    const double along = normal.dot(way[0]);
    const double size = normal.squaredNorm();
    return {p - (along / size) * normal, along * along / size, {Part::face, 0}};
  }
  OnTriangle best;
  for (std::uint8_t i = 0; i < 3; ++i) {
    const std::uint8_t j = i == 2 ? 0 : i + 1;
    const bool forward = ids[i] < ids[j];
    const std::uint8_t from = forward ? i : j;
    const std::uint8_t to = forward ? j : i;
    const Vec3 line = forward ? side[i] : Vec3(-side[i]);
    const double along = line.dot(way[from]);
    const double length2 = line.squaredNorm();
    OnTriangle at;
    if (along <= 0.0) {
      at = {corner[from], way[from].squaredNorm(), {Part::corner, from}};
    } else if (along >= length2) {
      at = {corner[to], way[to].squaredNorm(), {Part::corner, to}};
    } else {
      const double t = along / length2;
      at = {corner[from] + t * line, (way[from] - t * line).squaredNorm(), {Part::edge, i}};
    }
    if (i == 0 || at.square < best.square) best = at;
  }
  return best;
}

}  // namespace enc
