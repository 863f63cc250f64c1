// A triangle mesh as data, with its neighbours and normals.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace enc {

// Read from files, and the input of the search tree. Vertices in O, m; triangles counter-clockwise seen from
// outside.
struct Mesh {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::int32_t, 3>> triangles;
};

// Mesh data for the sign of the distance: neighbours across edges, and pseudo-normals of the vertices
// [Baerentzen and Aanaes 2005].

// The triangle across each edge i (from corner i to corner i + 1) of each triangle; -1: no neighbour.
[[nodiscard]] std::vector<std::array<std::int32_t, 3>> neighbours_of(const Mesh& mesh);

// Unit vertex normals: the mean of the surrounding face normals, weighted by their angles there; zero if they
// cancel.
[[nodiscard]] std::vector<std::array<double, 3>> vertex_normals_of(const Mesh& mesh);

}  // namespace enc
