// A hare that crouches: a closed organic surface of about 20,000 triangles, made here, so that it is free to
// use.
#pragma once

#include "core/shape/surface/mesh.h"

namespace enc::models {

// About 60 mm long, m, z up, nose along +x; the back is above the origin. Only + - * / and sqrt, so it is the
// same to the bit everywhere. models/meshes/hare.glb is this.
[[nodiscard]] Mesh hare_mesh();

}  // namespace enc::models
