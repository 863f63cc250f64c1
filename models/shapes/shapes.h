// Closed triangle meshes made by rule, for tests, benchmarks and examples: manifold, outward, in metres, the
// size of a hand.
#pragma once

#include <array>
#include <memory>

#include "core/base/frames.h"
#include "core/shape/surface/mesh.h"

namespace enc::models {

inline constexpr double kBallRadius = 0.033;  // m, tennis ball [VHMR 4.1]

// Geodesic ball: each face of an icosahedron cut into n^2 triangles, 20 n^2 in all. n = 71 has 100,820
// triangles, n = 224 has 1,003,520.
[[nodiscard]] Mesh geodesic_ball(int n, double radius = kBallRadius);
// Box around the origin with edges along x, y and z. Each edge is cut into `squares` parts, each square of a
// face into two triangles.
[[nodiscard]] Mesh box(const std::array<int, 3>& squares, const Vec3& size);
// The surface of an object with `shape = "box"`: fine enough to show a deformation.
[[nodiscard]] std::shared_ptr<const Mesh> box_surface(const Vec3& size);
// Cube of side `side` around the origin, each face n x n squares of two triangles.
[[nodiscard]] Mesh cube(int n, double side = 0.05);
// A turned part such as CAD exports: a stack of discs of unlike radius and height, `sides` around; rims a few
// um high, annular faces of long slivers.
[[nodiscard]] Mesh turned_part(int sides = 120);
// Bumpy tube along a (2,3) torus knot: `along` x `around` squares of two triangles, long across and short
// along.
[[nodiscard]] Mesh knot(int along, int around);

// A crouching hare: a closed organic surface of about 20,000 triangles, made here, so that it is free to use.
// About 60 mm long, m, z up, nose along +x; the back is above the origin. It uses only + - * / and sqrt, so
// the result is the same to the bit everywhere. models/meshes/hare.glb is this mesh.
[[nodiscard]] Mesh hare_mesh();

}  // namespace enc::models
