// Triangle meshes as files: OBJ, STL (text and binary) and glTF 2.0 (.gltf, .glb). docs/reference/mesh.md
// lists what is read and what is refused.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/frames.h"
#include "core/shape/surface/mesh.h"
#include "core/spec/object_spec.h"
#include "models/files.h"

namespace enc::models {

// A larger mesh is refused before memory of that size is allocated.
inline constexpr std::size_t kMostTriangles = 20'000'000;

struct FileMesh {
  Mesh mesh;
  std::vector<std::int32_t> lines{};          // OBJ only: line of each triangle's face, from 1
  std::vector<std::string> notes{};           // skipped or assumed content, one line each
  std::optional<SurfaceMaterial> material{};  // glTF only: material of most triangles
};

// The triangles of a file, in its order and its axes, m; vertices at equal positions are merged. All other
// repairs are in check_mesh(). Throws Error in one line: file:line:column for text, file: byte N for binary
// data.
[[nodiscard]] FileMesh load_faces(const std::string& path);
[[nodiscard]] Mesh load_mesh(const std::string& path);

// Parts of load_mesh(): each gives the vertices as they stand in the file.
// ---------------------------------------------------------------------------------------------------------
struct MeshBytes {
  const std::string& path;
  const std::string& bytes;

  [[noreturn]] void fail_at_byte(std::size_t byte, const std::string& what) const;
  [[noreturn]] void fail_at_text(std::size_t byte, const std::string& what) const;  // as line and column
};
[[nodiscard]] FileMesh read_obj(const MeshBytes& file);
// Adds the triangles of a polygon to a mesh. A convex polygon becomes a fan around its first corner, any
// other one is cut ear by ear. Returns the fault of a polygon that no plane surface fills; empty: no fault.
[[nodiscard]] std::string add_polygon(Mesh& mesh, const std::vector<std::int32_t>& polygon);
[[nodiscard]] FileMesh read_stl(const MeshBytes& file);
[[nodiscard]] FileMesh read_gltf(const MeshBytes& file, bool binary);
// Files may be padded in transfer: a rest after the end that is shorter than an STL triangle is skipped.
inline constexpr std::size_t kMostRest = 49;
// "a.stl: passed over 2 bytes after the last triangle"
[[nodiscard]] std::string rest_note(const MeshBytes& file, std::size_t rest, const std::string& after);
// The bytes of a .glb up to the length in its header, and their JSON. Header and chunks fit the file. This
// checks to the byte, because tinygltf 2.7 reads up to 8 bytes beyond a chunk that claims to be longer than
// the file.
struct Glb {
  std::size_t length = 0;
  std::string_view json;
};
[[nodiscard]] Glb parts_of_glb(const MeshBytes& file);
// Refuses a glTF that requires an extension which changes shapes, before any further reading: without the
// extension its accessors look damaged. `also_optional`: also refuses an extension that packs data and is
// only used.
void check_extensions(const MeshBytes& file, std::string_view json, bool binary, bool also_optional = false);
// tinygltf walks nested values by recursion and keeps some hundred bytes for each value. So this limits the
// nesting of a file, and the number of its values to kMostTriangles.
void check_json(const MeshBytes& file, std::string_view json, bool binary);

inline constexpr std::string_view kBom = "\xEF\xBB\xBF";  // UTF-8 mark that a text may begin with

// Reads a finite number from the whole word, whatever the locale; returns false otherwise.
[[nodiscard]] bool read_number(std::string_view word, double& number);
// Merges vertices at bit-equal positions.
void weld(Mesh& mesh);
// Hash of vertices and triangles, to detect a changed mesh.
[[nodiscard]] std::uint64_t content_hash(const Mesh& mesh);

// Writes a mesh as .glb, .obj or (binary) .stl, in metres. Equal meshes give equal bytes on every machine.
// The path's ending selects the format. .glb and .stl keep float, .obj keeps double. Throws Error.
void write_mesh(const Mesh& mesh, const std::string& path, OverwritePolicy existing = OverwritePolicy::keep);
// `ending`: ".glb", ".obj" or ".stl"
[[nodiscard]] std::string mesh_bytes(const Mesh& mesh, const std::string& ending);

// Query points for a mesh's nearest points: a table with exactly the columns x_m,y_m,z_m. path: for messages
// "path:line:column: ...". Throws Error: another header, not a number, a point beyond 1e6 m.
[[nodiscard]] std::vector<Vec3> parse_places(const std::string& text, const std::string& path);

}  // namespace enc::models
