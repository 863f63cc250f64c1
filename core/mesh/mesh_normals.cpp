#include "core/mesh/mesh_normals.h"

#include <algorithm>
#include <cmath>

#include "core/frames.h"
#include "core/mesh/triangle.h"

namespace enc {
namespace {

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

}  // namespace

std::vector<std::array<std::int32_t, 3>> neighbours_of(const Mesh& mesh) {
  // All directed edges in buckets by their lower end; the same edge the other way round is in the same
  // bucket.
  struct Edge {
    std::int32_t to, slot;  // the higher end; 3 * triangle + i, ~ of it where it runs from high to low
  };
  std::vector<std::int32_t> start(mesh.vertices.size() + 1, 0);
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) ++start[index(std::min(t[i], t[(i + 1) % 3])) + 1];
  for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  std::vector<Edge> edges(3 * mesh.triangles.size());
  std::vector<std::int32_t> filled(start.begin(), start.end() - 1);
  std::vector<std::array<std::int32_t, 3>> across(mesh.triangles.size(), {-1, -1, -1});
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = mesh.triangles[k][i];
      const std::int32_t b = mesh.triangles[k][(i + 1) % 3];
      const auto slot = static_cast<std::int32_t>(3 * k + i);
      const std::int32_t low = std::min(a, b);
      std::int32_t& end = filled[index(low)];
      for (std::int32_t e = start[index(low)]; e < end; ++e) {
        Edge& other = edges[index(e)];
        if (other.to != std::max(a, b) || (other.slot < 0) != (a < b)) continue;
        const std::int32_t twin = other.slot < 0 ? ~other.slot : other.slot;
        across[k][i] = twin / 3;
        across[index(twin / 3)][index(twin % 3)] = static_cast<std::int32_t>(k);
        break;
      }
      edges[index(end++)] = {std::max(a, b), a < b ? slot : ~slot};
    }
  return across;
}

std::vector<std::array<double, 3>> vertex_normals_of(const Mesh& mesh) {
  std::vector<std::array<double, 3>> normals(mesh.vertices.size(), {0.0, 0.0, 0.0});
  for (const auto& t : mesh.triangles) {
    const std::array<Vec3, 3> c{vec(mesh.vertices[index(t[0])]), vec(mesh.vertices[index(t[1])]),
                                vec(mesh.vertices[index(t[2])])};
    const Vec3 normal = (c[1] - c[0]).cross(c[2] - c[1]);
    const double size = normal.norm();
    if (!(size > 0.0)) continue;  // no area, no say
    for (std::size_t i = 0; i < 3; ++i) {
      const double angle = std::atan2(size, (c[(i + 1) % 3] - c[i]).dot(c[(i + 2) % 3] - c[i]));
      for (int x = 0; x < 3; ++x) normals[index(t[i])][index(x)] += angle / size * normal[x];
    }
  }
  for (auto& n : normals) {
    const double size = vec(n).norm();
    for (double& x : n) x = size > 1e-9 ? x / size : 0.0;
  }
  return normals;
}

}  // namespace enc
