#include "models/mesh_files/mesh_parts.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/frames.h"

namespace enc::models {
namespace {

// Faces that are looked at: some seconds, and so many times all of them.
constexpr std::size_t kMostRound = 100'000'000, kMostRoundEach = 64;

Vec3 corner_of(const Mesh& mesh, std::size_t face, std::size_t i) {
  return Vec3(mesh.vertices[static_cast<std::size_t>(mesh.triangles[face][i])].data());
}

// The faces of a part, and a box around them.
struct Extent {
  std::vector<std::size_t> faces{};
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  [[nodiscard]] bool holds(const Vec3& p) const {
    return (low.array() <= p.array()).all() && (p.array() <= high.array()).all();
  }
};

std::vector<Extent> extents_of(const Mesh& mesh, const std::vector<std::int32_t>& part, std::size_t parts) {
  std::vector<Extent> all(parts);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    Extent& of = all[static_cast<std::size_t>(part[f])];
    of.faces.push_back(f);
    for (std::size_t i = 0; i < 3; ++i) {
      of.low = of.low.cwiseMin(corner_of(mesh, f, i));
      of.high = of.high.cwiseMax(corner_of(mesh, f, i));
    }
  }
  return all;
}

// Whether a part goes round a point, by its winding number there [van Oosterom and Strackee 1983].
bool goes_round(const Mesh& mesh, const Extent& part, const Vec3& probe) {
  double angle = 0.0;
  for (const std::size_t f : part.faces) {
    const Vec3 a = corner_of(mesh, f, 0) - probe, b = corner_of(mesh, f, 1) - probe,
               c = corner_of(mesh, f, 2) - probe;
    const double na = a.norm(), nb = b.norm(), nc = c.norm();
    angle +=
        2.0 * std::atan2(a.dot(b.cross(c)), na * nb * nc + a.dot(b) * nc + b.dot(c) * na + c.dot(a) * nb);
  }
  return std::abs(angle) > 2.0 * std::numbers::pi;
}

}  // namespace

// By one vertex of each part; only a part whose box holds that vertex is looked at.
std::vector<int> depths_of(const Mesh& mesh, const std::vector<std::int32_t>& part, std::size_t parts) {
  std::vector<int> depth(parts, 0);
  if (parts < 2) return depth;
  const std::vector<Extent> all = extents_of(mesh, part, parts);
  std::size_t work = 0;
  for (std::size_t p = 0; p < parts; ++p) {
    const Vec3 probe = corner_of(mesh, all[p].faces.back(), 0);
    for (std::size_t other = 0; other < parts; ++other) {
      if (other == p || !all[other].holds(probe)) continue;
      work += all[other].faces.size();
      if (work > kMostRound + kMostRoundEach * mesh.triangles.size()) return {};
      depth[p] += goes_round(mesh, all[other], probe) ? 1 : 0;
    }
  }
  return depth;
}

}  // namespace enc::models
