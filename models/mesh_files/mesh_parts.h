// Finds the separate parts of a mesh that lie in others. Internal to check_mesh().
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/shape/surface/mesh.h"

namespace enc::models {

// Number of other parts around each part. `part`: of each face, from 0; every part has a face. Empty if the
// answer would take minutes, because too many parts lie in the boxes around others.
[[nodiscard]] std::vector<int> depths_of(const Mesh& mesh, const std::vector<std::int32_t>& part,
                                         std::size_t parts);

}  // namespace enc::models
