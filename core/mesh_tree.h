// Nearest point on a triangle mesh, with its sign: by trying every triangle.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh.h"
#include "core/surface.h"

namespace enc {

class MeshTree {
 public:
  // Precondition, checked where files are read: closed, manifold, consistently oriented, all finite.
  explicit MeshTree(const Mesh& mesh);
  // `feature` is the index of the triangle. On edges and corners the normal, and the sign, is that of the
  // pseudo-normal weighted by angle [Baerentzen and Aanaes 2005].
  [[nodiscard]] Nearest nearest(const Point<'O'>& p, std::int32_t hint = -1) const noexcept;
  [[nodiscard]] const Mesh& mesh() const { return mesh_; }
  [[nodiscard]] Ball bound() const { return {Point<'O'>(centre_), radius_}; }

 private:
  [[nodiscard]] Vec3 corner(std::int32_t triangle, std::size_t i) const noexcept;
  [[nodiscard]] Vec3 face_normal(std::int32_t triangle) const noexcept;

  Mesh mesh_;
  std::vector<std::array<std::int32_t, 3>> neighbours_;  // across the edge from corner i to i + 1
  std::vector<Vec3> vertex_normals_;
  Vec3 centre_ = Vec3::Zero();
  double radius_ = 0.0;
};

}  // namespace enc
