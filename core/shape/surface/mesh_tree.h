// Nearest point on a triangle mesh, with its sign. A tree of eight-way nodes whose boxes stand in each node's
// own frame. A box that lies flat on a curved patch has a slack of s^2 / r, an axis-aligned one of s; on a
// ball that is a factor of ten in time. Nodes and leaves are float and only exclude candidates, with safe
// bounds; the answer is computed in double.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/shape/surface/mesh.h"
#include "core/shape/surface/surface.h"

namespace enc {

// Largest coordinate of a vertex along each axis of O, m: squares of distances stay finite in float.
inline constexpr double kFarthestVertex = 1e6;

// Built once, constant while the loop runs, and shared by all users.
class MeshTree {
 public:
  // Precondition, checked when files are read: closed, manifold, consistently oriented, no vertex beyond
  // kFarthestVertex, at least one triangle.
  explicit MeshTree(const Mesh& mesh);

  // `feature` is the index of the triangle, `hint` the one from the last query: it makes the search faster,
  // and never changes the answer.
  //
  // If several triangles are equally near (on an edge, at a corner, on the medial axis), the lowest index
  // wins. Equally near means: the squares of the distances, cut to 40 binary digits (1e-12), are equal, or
  // both distances are below 1e-14 of the mesh's size. So the answer depends on p alone.
  //
  // `normal` is that of the face if the nearest point is inside a face. On an edge or a corner it is the
  // pseudo-normal there, weighted by angle, which also gives the sign [Baerentzen and Aanaes 2005]. On the
  // surface itself the distance is 0. A p that is not finite, or farther than 1e9 m, has no answer: all is
  // NaN and `feature` is -1.
  [[nodiscard]] SurfacePoint nearest(const Point<'O'>& p, std::int32_t hint = -1) const noexcept;

  [[nodiscard]] const Mesh& mesh() const { return mesh_; }
  [[nodiscard]] Ball bound() const { return {Point<'O'>(centre_), radius_}; }
  [[nodiscard]] std::size_t memory_bytes() const;
  // Pseudo-normals, unit; zero if the mesh defines no normal there (all faces around have no area).
  [[nodiscard]] Vec3 face_normal(std::int32_t triangle) const noexcept;
  [[nodiscard]] Vec3 edge_normal(std::int32_t triangle, int edge) const noexcept;
  [[nodiscard]] Vec3 vertex_normal(std::int32_t vertex) const noexcept;

 private:
  static constexpr int kWay = 8;          // children of a node, triangles of a leaf
  static constexpr int kMostLevels = 11;  // 8^11 > 2^31 / 8
  using Eight = std::array<float, kWay>;
  // Child i of node j of a level is number 8 j + i of the next, down to the leaves: the tree is complete and
  // needs no pointers. Frame: x_node = axes * (p - centre of the mesh) + shift.
  struct alignas(64) Node {
    std::array<std::array<float, 3>, 3> axes;  // rows
    std::array<float, 3> shift;
    std::array<Eight, 3> low, high;  // boxes of the children; low > high: no child
  };
  // Triangles in their own planes: corner a, the longest edge along u, the third corner on the side of v.
  struct alignas(32) Leaf {
    std::array<Eight, 3> a, u, v;
    Eight bx, cx, cy;  // corners in (u, v): (0, 0), (bx, 0), (cx, cy)
    std::array<std::int32_t, kWay> triangle;
  };
  struct Search;
  class Builder;
  [[nodiscard]] std::array<Vec3, 3> corners(std::int32_t triangle) const noexcept;

  Mesh mesh_;
  std::vector<std::array<std::int32_t, 3>> neighbours_;  // across edge i of a triangle; -1: no neighbour
  std::vector<std::array<double, 3>> vertex_normals_;
  std::vector<Node> nodes_;  // the root first, then level by level
  std::vector<Leaf> leaves_;
  std::array<std::int32_t, kMostLevels> level_{};  // first node of each level, 0 is above the leaves
  int levels_ = 0;
  Vec3 centre_ = Vec3::Zero();  // centre of the box around all vertices
  double radius_ = 0.0;         // radius of a ball around centre_ that holds all vertices
};

}  // namespace enc
