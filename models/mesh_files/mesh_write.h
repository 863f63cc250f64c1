// Writes a mesh as .glb, .obj or (binary) .stl, in metres. Equal meshes give equal bytes on every machine.
#pragma once

#include <string>

#include "core/shape/surface/mesh.h"
#include "models/files.h"

namespace enc::models {

// The path's ending selects the format. .glb and .stl keep float, .obj keeps double. Throws Error.
void write_mesh(const Mesh& mesh, const std::string& path, Existing existing = Existing::keep);
// `ending`: ".glb", ".obj" or ".stl"
[[nodiscard]] std::string mesh_bytes(const Mesh& mesh, const std::string& ending);

}  // namespace enc::models
