// Writes a mesh as .glb, .obj or (binary) .stl, in metres. The same mesh gives the same bytes on every
// machine.
#pragma once

#include <string>

#include "core/shape/surface/mesh.h"
#include "models/files.h"

namespace enc::models {

// By the ending of the path. .glb and .stl keep float, .obj keeps double. Throws Error.
void write_mesh(const Mesh& mesh, const std::string& path, Existing existing = Existing::keep);
// `ending`: ".glb", ".obj" or ".stl"
[[nodiscard]] std::string mesh_bytes(const Mesh& mesh, const std::string& ending);

}  // namespace enc::models
