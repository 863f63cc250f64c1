// Which faces meet at which edges. At edges of only one face, corners that are one but for the last digits of
// a float are joined, and what stays open is measured. Internal to check_mesh().
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
  bool same = true;  // turns the same way
};
// An edge of only one face, which runs along it in this order.
struct OpenEdge {
  std::int32_t from, to, face;
};
struct Edges {
  std::vector<std::array<Neighbour, 3>>
      neighbours;  // across each side of a face, where exactly two faces meet
  std::vector<OpenEdge> open;
  std::vector<std::size_t>
      crowded;  // faces at an edge of three or more; one for each such edge that a face has
};
[[nodiscard]] Edges edges_of(const Mesh& mesh);

struct Weld {
  std::size_t corners = 0;  // joined to another one
  double farthest = 0.0;    // m: the longest way of one of them

  Weld& operator+=(const Weld& more) {
    corners += more.corners;
    farthest = farthest > more.farthest ? farthest : more.farthest;
    return *this;
  }
};

// One digit of 4 units in its last place on either side of a corner.
inline constexpr int kMostSteps = 8;
// Joins ends of open edges that are at most `steps` float steps apart along each axis: 1.2e-7 of the larger
// of the mesh's size and its farthest coordinate on that axis. A vertex that no open edge has stays alone,
// however near another one is: two closed surfaces are never joined. Gives up after 100 million pairs, and
// does nothing about more than 4 million open edges: that would take a minute.
[[nodiscard]] Weld weld_open(Mesh& mesh, const std::vector<OpenEdge>& open, int steps);

// How far apart the two sides of a hole are.
struct Gap {
  double width = kUnset;     // m: the widest; unset where an edge has no opposite one
  double of_size = kUnset;   // the width over the mesh's longest side
  bool beside_edge = false;  // a corner has another face's edge beside it, and none of its ends (T-junction)
};
// For the ends and the middle of open edges: the distance to the nearest open edge that runs the other way.
// All open edges count up to 3,000, and every n-th of more.
[[nodiscard]] Gap widest_gap(const Mesh& mesh, const std::vector<OpenEdge>& open);

}  // namespace enc::models
