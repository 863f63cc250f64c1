#include "core/shape/surface/mesh.h"

#include <algorithm>
#include <cmath>

#include "core/base/frames.h"
#include "core/shape/surface/triangle.h"

namespace enc {
namespace {

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

}  // namespace

std::vector<std::array<std::int32_t, 3>> neighbours_of(const Mesh& mesh) {
  // All directed edges, in buckets by their lower end and sorted by their higher end. So the two directions
  // of an edge are adjacent, however many edges meet at a vertex.
  struct Edge {
    std::int32_t to, slot;  // the higher end; 3 * triangle + i, inverted (~) if the edge runs from high to
                            // low
    [[nodiscard]] std::int32_t place() const { return slot < 0 ? ~slot : slot; }
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
      edges[index(filled[index(std::min(a, b))]++)] = {std::max(a, b), a < b ? slot : ~slot};
    }
  for (std::size_t v = 0; v + 1 < start.size(); ++v) {
    const auto first = edges.begin() + start[v], last = edges.begin() + start[v + 1];
    std::sort(first, last, [](const Edge& a, const Edge& b) {
      return a.to != b.to ? a.to < b.to : a.place() < b.place();
    });
    for (auto e = first; e != last && e + 1 != last; ++e) {
      const Edge &one = e[0], &other = e[1];
      if (one.to != other.to || (one.slot < 0) == (other.slot < 0)) continue;
      across[index(one.place() / 3)][index(one.place() % 3)] = other.place() / 3;
      across[index(other.place() / 3)][index(other.place() % 3)] = one.place() / 3;
    }
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
    if (!(size > 0.0)) continue;  // no area, no weight
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
