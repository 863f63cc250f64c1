// Is a mesh the surface of a solid? What is not is named with its first bad faces, and repaired where that is
// safe. A signed distance, and so a haptic surface, exists only for a closed, outward, simple surface.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/shape/surface/mesh.h"
#include "core/spec/surface_material.h"

namespace enc::models {

struct CheckedMesh {
  Mesh mesh;                                  // closed, manifold, outward, without faces of zero area
  std::vector<std::string> notes;             // what was repaired or not checked, one line each
  std::optional<SurfaceMaterial> material{};  // as the file says
};

// Above this many triangles self-intersection is not looked for, and a note says so: it would take seconds.
inline constexpr std::size_t kMostTouchTested = 300'000;

// Corners of open edges that differ in the last digits of a float alone are joined (mesh_edges.h). `name`
// begins every message. Faces are numbered from 0 in the order of the file, or named by their `lines`, one
// for each triangle. Throws Error where the mesh is open, non-manifold, has faces of no area, is not
// orientable, or meets itself.
[[nodiscard]] CheckedMesh check_mesh(Mesh mesh, const std::string& name,
                                     const std::vector<std::int32_t>& lines = {});
// load_faces() and check_mesh().
[[nodiscard]] CheckedMesh load_solid(const std::string& path);

// Parts of check_mesh().
// ---------------------------------------------------------------------------------------------------------
struct Touching {
  std::vector<std::size_t> crossing;  // faces that pass through another one, or lie folded on a neighbour
  std::vector<std::size_t> touching;  // that touch one beside a common corner or edge; each once, in order
  std::size_t touched = 0;            // the face that the first of these touches
  double depth = 0.0;                 // m: the shift that parts two crossing faces; the largest of all pairs
  bool finished = true;               // false: given up after 100 million pairs
};
// Faces that meet where they should not. They touch where they are no farther apart than 1e-12 of the mesh's
// size: nearer than that the search cannot tell whose side a point is on. Boxes in a tree: about n log n for
// a mesh of even triangles.
[[nodiscard]] Touching touching_faces(const Mesh& mesh);
// "face 12", "faces 12, 15 and 3 more"; "faces of lines 12 and 15"
[[nodiscard]] std::string face_list(const std::vector<std::size_t>& faces, bool lines = false);

}  // namespace enc::models
