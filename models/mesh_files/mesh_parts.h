// Which of the separate parts of a mesh lie in others. Internal to check_mesh().
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/shape/surface/mesh.h"

namespace enc::models {

// In how many other parts each part lies. `part`: of each face, from 0; every part has one. Empty where to
// say it would take minutes: too many parts lie in the boxes around others.
[[nodiscard]] std::vector<int> depths_of(const Mesh& mesh, const std::vector<std::int32_t>& part,
                                         std::size_t parts);

}  // namespace enc::models
