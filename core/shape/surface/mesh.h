// A triangle mesh as data: what files give and what the search tree is built from. Vertices in O, m;
// triangles counter-clockwise seen from outside.
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
