#include "core/mesh_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace enc {
namespace {

// Barycentric coordinates of the point of a triangle that is nearest to p [Ericson 2005, 5.1.5].
Vec3 nearest_weights(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp),
               d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - t, t};
  }
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

}  // namespace

Vec3 MeshTree::corner(std::int32_t triangle, std::size_t i) const noexcept {
  return Vec3(mesh_.vertices[static_cast<std::size_t>(mesh_.triangles[static_cast<std::size_t>(triangle)][i])]
                  .data());
}

Vec3 MeshTree::face_normal(std::int32_t triangle) const noexcept {
  const Vec3 a = corner(triangle, 0);
  return (corner(triangle, 1) - a).cross(corner(triangle, 2) - a).normalized();
}

MeshTree::MeshTree(const Mesh& mesh)
    : mesh_(mesh),
      neighbours_(mesh.triangles.size(), {-1, -1, -1}),
      vertex_normals_(mesh.vertices.size(), Vec3::Zero()) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> edges;
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      edges[{mesh_.triangles[t][i], mesh_.triangles[t][(i + 1) % 3]}] = static_cast<std::int32_t>(t);
      const auto n = static_cast<std::int32_t>(t);
      const Vec3 u = (corner(n, (i + 1) % 3) - corner(n, i)).normalized(),
                 v = (corner(n, (i + 2) % 3) - corner(n, i)).normalized();
      vertex_normals_[static_cast<std::size_t>(mesh_.triangles[t][i])] +=
          std::atan2(u.cross(v).norm(), u.dot(v)) * face_normal(n);
    }
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      neighbours_[t][i] = edges[{mesh_.triangles[t][(i + 1) % 3], mesh_.triangles[t][i]}];
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& v : mesh_.vertices) {
    low = low.cwiseMin(Vec3(v.data()));
    high = high.cwiseMax(Vec3(v.data()));
  }
  centre_ = 0.5 * (low + high);
  for (const auto& v : mesh_.vertices) radius_ = std::max(radius_, (Vec3(v.data()) - centre_).norm());
}

Nearest MeshTree::nearest(const Point<'O'>& p, std::int32_t /*hint*/) const noexcept {
  Nearest best;
  double least = std::numeric_limits<double>::infinity();
  Vec3 weights = Vec3::Zero();
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
    const auto n = static_cast<std::int32_t>(t);
    const Vec3 a = corner(n, 0), b = corner(n, 1), c = corner(n, 2), w = nearest_weights(p.e(), a, b, c);
    const Vec3 q = w[0] * a + w[1] * b + w[2] * c;
    const double d2 = (p.e() - q).squaredNorm();
    if (!(d2 < least)) continue;
    least = d2;
    weights = w;
    best.point = Point<'O'>(q);
    best.feature = n;
  }
  if (best.feature < 0) return best;
  const auto t = static_cast<std::size_t>(best.feature);
  Vec3 normal = face_normal(best.feature);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (weights[at] == 0.0 && weights[(at + 1) % 3] != 0.0 && weights[(at + 2) % 3] != 0.0)
      normal = (normal + face_normal(neighbours_[t][(i + 1) % 3])).normalized();
    if (weights[at] == 1.0)
      normal = vertex_normals_[static_cast<std::size_t>(mesh_.triangles[t][i])].normalized();
  }
  best.normal = Vec<'O'>(normal);
  best.distance = std::copysign(std::sqrt(least), normal.dot(p.e() - best.point.e()));
  return best;
}

}  // namespace enc
