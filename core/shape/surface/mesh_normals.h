// What of a mesh the sign needs: which triangles meet at an edge, and the pseudo-normals of the vertices
// [Baerentzen and Aanaes 2005].
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/shape/surface/mesh.h"

namespace enc {

// For each triangle the one across its edge i (from corner i to corner i + 1); -1 where there is none.
[[nodiscard]] std::vector<std::array<std::int32_t, 3>> neighbours_of(const Mesh& mesh);

// Unit normals of the faces around a vertex, weighted by their angles there, made unit; zero where they
// cancel.
[[nodiscard]] std::vector<std::array<double, 3>> vertex_normals_of(const Mesh& mesh);

}  // namespace enc
