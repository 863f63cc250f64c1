// Checks that a mesh is the surface of a solid. It names the first bad faces, and repairs a mesh if that is
// safe. A signed distance, and so a haptic surface, exists only for a closed, outward, simple surface.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/shape/surface/mesh.h"
#include "core/spec/object_spec.h"

namespace enc::models {

struct CheckedMesh {
  Mesh mesh;                                  // closed, manifold, outward, without faces of zero area
  std::vector<std::string> notes;             // repairs and skipped checks, one line each
  std::optional<SurfaceMaterial> material{};  // material from the file
};

// Above this many triangles the check for self-intersection is skipped, with a note, because it would take
// seconds.
inline constexpr std::size_t kMostTouchTested = 300'000;

// Joins corners of open edges that differ only in the last digits of a float (mesh_edges.h). `name` begins
// every message. Faces are numbered from 0 in the order of the file, or named by their `lines`, one for each
// triangle. Throws Error if the mesh is open, non-manifold, has faces without area, is not orientable, or
// intersects itself.
[[nodiscard]] CheckedMesh check_mesh(Mesh mesh, const std::string& name,
                                     const std::vector<std::int32_t>& lines = {});
// load_faces() and check_mesh().
[[nodiscard]] CheckedMesh load_solid(const std::string& path);

// Parts of check_mesh().
// ---------------------------------------------------------------------------------------------------------
struct Touching {
  std::vector<std::size_t> crossing;  // faces that pass through another one, or lie folded on a neighbour
  std::vector<std::size_t>
      touching;             // faces that touch one other than at a common corner or edge; each once, in order
  std::size_t touched = 0;  // face touched by the first of these
  double depth = 0.0;       // m: shift that separates two crossing faces; the largest of all pairs
  bool finished = true;     // false: stopped after 100 million pairs
};
// Faces that meet where they should not. Two faces touch if they are no farther apart than 1e-12 of the
// mesh's size: below that, the search cannot decide on which side a point is. Boxes in a tree: about n log n
// for a mesh of even triangles.
[[nodiscard]] Touching touching_faces(const Mesh& mesh);
// "face 12", "faces 12, 15 and 3 more"; "faces of lines 12 and 15"
[[nodiscard]] std::string face_list(const std::vector<std::size_t>& faces, bool lines = false);

}  // namespace enc::models
