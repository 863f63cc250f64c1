#include "core/vision/augment/facets.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/shape/surface/mesh_tree.h"
#include "core/vision/stereo/triangulate.h"

namespace enc::augment {
namespace {

constexpr float kDark = 0.72F;  // field of a chequer board, and sides of a button

// A grid of (across + 1) x (down + 1) corners, in rows, as two triangles a field.
void add_grid(int across, int down, bool chequered, Facets& facets) {
  const auto first = static_cast<std::int32_t>(facets.corners.size()) - (across + 1) * (down + 1);
  for (int j = 0; j < down; ++j)
    for (int i = 0; i < across; ++i) {
      const std::int32_t a = first + j * (across + 1) + i, b = a + across + 1;
      const float shade = chequered && (i + j) % 2 != 0 ? kDark : 1.0F;
      facets.triangles.push_back({{a, a + 1, b + 1}, shade});
      facets.triangles.push_back({{a, b + 1, b}, shade});
    }
}

Facets of(const Plane&) {
  constexpr int kFields = 6;
  Facets facets;
  for (int j = 0; j <= kFields; ++j)
    for (int i = 0; i <= kFields; ++i)
      facets.corners.emplace_back(kPatch * (static_cast<double>(i) / kFields - 0.5),
                                  kPatch * (static_cast<double>(j) / kFields - 0.5), 0.0);
  add_grid(kFields, kFields, true, facets);
  return facets;
}

Facets of(const Sphere& sphere) {
  constexpr int kAround = 32, kDown = 16;
  Facets facets;
  for (int j = 0; j <= kDown; ++j)
    for (int i = 0; i <= kAround; ++i) {
      const double polar = M_PI * j / kDown, azimuth = 2.0 * M_PI * i / kAround;
      facets.corners.emplace_back(
          Vec3(sphere.radius * Vec3(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                                    std::cos(polar))));
    }
  add_grid(kAround, kDown, false, facets);
  return facets;
}

// Its face, then a side of each edge.
Facets of(const Button& button) {
  Facets facets;
  const double x = 0.5 * button.width, y = 0.5 * button.height;
  for (const double z : {0.0, -button.thickness})
    for (const auto& [u, v] : {std::pair{-x, -y}, {x, -y}, {x, y}, {-x, y}})
      facets.corners.emplace_back(u, v, z);
  facets.triangles = {{{0, 1, 2}, 1.0F}, {{0, 2, 3}, 1.0F}};
  for (std::int32_t i = 0; i < 4; ++i) {
    const std::int32_t next = (i + 1) % 4;
    facets.triangles.push_back({{i, i + 4, next + 4}, kDark});
    facets.triangles.push_back({{i, next + 4, next}, kDark});
  }
  return facets;
}

Facets of(const MeshSurface& surface) {
  Facets facets;
  for (const auto& [x, y, z] : surface.tree->mesh().vertices) facets.corners.emplace_back(x, y, z);
  for (const auto& corner : surface.tree->mesh().triangles) facets.triangles.push_back({corner, 1.0F});
  return facets;
}

struct Corner {
  double column, row, near;  // px, px, 1/m
};

double edge(const Corner& a, const Corner& b, double x, double y) {
  return (b.column - a.column) * (y - a.row) - (b.row - a.row) * (x - a.column);
}

// 1 / depth is linear in the picture.
void fill(const std::array<Corner, 3>& c, float shade, Seen& seen) {
  const double area = edge(c[0], c[1], c[2].column, c[2].row);
  if (area == 0.0) return;
  const auto [left, right] = std::minmax({c[0].column, c[1].column, c[2].column});
  const auto [top, bottom] = std::minmax({c[0].row, c[1].row, c[2].row});
  const int x0 = static_cast<int>(std::ceil(std::max(0.0, left)));
  const int x1 = static_cast<int>(std::floor(std::min(right, seen.width - 1.0)));
  const int y1 = static_cast<int>(std::floor(std::min(bottom, seen.height - 1.0)));
  for (int y = static_cast<int>(std::ceil(std::max(0.0, top))); y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const double u = edge(c[1], c[2], x, y) / area, v = edge(c[2], c[0], x, y) / area, w = 1.0 - u - v;
      if (u < 0.0 || v < 0.0 || w < 0.0) continue;
      const auto at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(seen.width) + static_cast<std::size_t>(x);
      const auto depth = static_cast<float>(1.0 / (u * c[0].near + v * c[1].near + w * c[2].near));
      if (depth >= seen.depth[at]) continue;
      seen.depth[at] = depth;
      seen.shade[at] = shade;
    }
}

}  // namespace

Facets facets_of(const Surface& surface) {
  return std::visit([](const auto& shape) { return of(shape); }, surface.shape());
}

Seen::Seen(int w, int h)
    : width(w),
      height(h),
      depth(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)),
      shade(depth.size()) {
  clear();
}

void Seen::clear() { std::fill(depth.begin(), depth.end(), std::numeric_limits<float>::infinity()); }

void draw(const Facets& facets, const RectifiedPair& pair, const Pose<'C', 'O'>& X_CO, Seen& seen) {
  std::vector<Vec3> in_C;
  std::vector<Corner> corners;
  for (const Point<'O'>& corner : facets.corners) {
    const Point<'C'> p = X_CO * corner;
    const Triplet at = seen_at(pair, p);
    in_C.emplace_back(p.e());
    corners.push_back({at.column, at.row, at.disparity / (pair.focal * pair.baseline)});
  }
  for (const Facets::Triangle& triangle : facets.triangles) {
    std::array<Corner, 3> c{};
    std::array<Vec3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
      c[i] = corners[static_cast<std::size_t>(triangle.corner[i])];
      p[i] = in_C[static_cast<std::size_t>(triangle.corner[i])];
    }
    if (!(c[0].near > 0.0 && c[1].near > 0.0 && c[2].near > 0.0)) continue;
    // A lamp beside the camera.
    const Vec3 normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    const double light = 0.5 + 0.5 * std::abs(normal.dot(p[0].normalized()));
    fill(c, triangle.shade * static_cast<float>(light), seen);
  }
}

}  // namespace enc::augment
