// A crouching hare: a closed organic surface of about 20,000 triangles, made here, so that it is free to use.
#pragma once

#include "core/shape/surface/mesh.h"

namespace enc::models {

// About 60 mm long, m, z up, nose along +x; the back is above the origin. It uses only + - * / and sqrt, so
// the result is the same to the bit everywhere. models/meshes/hare.glb is this mesh.
[[nodiscard]] Mesh hare_mesh();

}  // namespace enc::models
