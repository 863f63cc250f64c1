// A triangle mesh as data: read from files, and the input of the search tree. Vertices in O, m; triangles
// counter-clockwise seen from outside.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace enc {

struct Mesh {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::int32_t, 3>> triangles;
};

}  // namespace enc
