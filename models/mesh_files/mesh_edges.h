// The edges of a mesh and its separate parts: finds the faces at each edge. At edges with a single face, it
// joins corners that differ only in the last digits of a float, and measures the remaining gaps. Internal to
// check_mesh().
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/frames.h"
#include "core/shape/surface/mesh.h"

namespace enc::models {

struct Neighbour {
  std::int32_t face = -1;
  bool same = true;  // has the same orientation
};
// An edge with a single face, which runs along it in this order.
struct OpenEdge {
  std::int32_t from, to, face;
};
struct Edges {
  // Across each side of a face, if exactly two faces meet there.
  std::vector<std::array<Neighbour, 3>> neighbours;
  std::vector<OpenEdge> open;
  // Faces at an edge of three or more; one entry for each such edge of a face.
  std::vector<std::size_t> crowded;
};
[[nodiscard]] Edges edges_of(const Mesh& mesh);

struct Weld {
  std::size_t corners = 0;  // number of corners joined to another one
  double farthest = 0.0;    // m: largest displacement of a corner

  Weld& operator+=(const Weld& more) {
    corners += more.corners;
    farthest = farthest > more.farthest ? farthest : more.farthest;
    return *this;
  }
};

// One digit of 4 units in the last place on either side of a corner.
inline constexpr int kMostSteps = 8;
// Joins ends of open edges that are at most `steps` float steps apart along each axis: 1.2e-7 of the larger
// of the mesh's size and its farthest coordinate on that axis. A vertex without an open edge stays separate,
// however near another one is: two closed surfaces are never joined. Stops after 100 million pairs, and does
// nothing for more than 4 million open edges, because that would take a minute.
[[nodiscard]] Weld weld_open(Mesh& mesh, const std::vector<OpenEdge>& open, int steps);

// Distance between the two sides of a hole.
struct Gap {
  double width = kUnset;    // m: the widest; unset: an edge has no opposite one
  double of_size = kUnset;  // width over the mesh's longest side
  bool beside_edge =
      false;  // a corner is beside another face's edge, but not at one of its ends (T-junction)
};
// Measures, at the ends and the middle of open edges, the distance to the nearest open edge with opposite
// direction. Uses all open edges up to 3,000, and every n-th of more.
[[nodiscard]] Gap widest_gap(const Mesh& mesh, const std::vector<OpenEdge>& open);

// Number of other parts around each part. `part`: of each face, from 0; every part has a face. Empty if the
// answer would take minutes, because too many parts lie in the boxes around others.
[[nodiscard]] std::vector<int> depths_of(const Mesh& mesh, const std::vector<std::int32_t>& part,
                                         std::size_t parts);

}  // namespace enc::models
