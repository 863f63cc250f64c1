// Triangle meshes as files: OBJ, STL (text and binary) and glTF 2.0 (.gltf, .glb). What is read and what is
// refused: docs/reference/mesh.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/shape/surface/mesh.h"
#include "core/spec/surface_material.h"

namespace enc::models {

// More is refused before anything of that size is allocated.
inline constexpr std::size_t kMostTriangles = 20'000'000;

struct FileMesh {
  Mesh mesh;
  std::vector<std::int32_t> lines{};          // of an OBJ: where the face of each triangle stands, from 1
  std::vector<std::string> notes{};           // what was passed over or assumed, one line each
  std::optional<SurfaceMaterial> material{};  // of glTF: that of most triangles
};

// The triangles of a file, in its order and its axes, m; vertices at the same place are one. Nothing else is
// repaired: that is check_mesh(). Throws Error of one line: file:line:column of a text, file: byte N of
// bytes.
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
// Adds the triangles of a polygon to a mesh. What is convex becomes a fan around its first corner, all else
// is cut ear by ear. Gives what is wrong with a polygon that no plane surface fills; empty: nothing.
[[nodiscard]] std::string add_polygon(Mesh& mesh, const std::vector<std::int32_t>& polygon);
[[nodiscard]] FileMesh read_stl(const MeshBytes& file);
[[nodiscard]] FileMesh read_gltf(const MeshBytes& file, bool binary);
// Files are padded on their way: fewer bytes than an STL has for a triangle, after the end, are passed over.
inline constexpr std::size_t kMostRest = 49;
// "a.stl: passed over 2 bytes after the last triangle"
[[nodiscard]] std::string rest_note(const MeshBytes& file, std::size_t rest, const std::string& after);
// The bytes of a .glb up to the length in its header, and their JSON. Header and chunks fit the file. Checked
// here to the byte, because tinygltf 2.7 reads up to 8 bytes beyond a chunk that claims to be longer than the
// file.
struct Glb {
  std::size_t length = 0;
  std::string_view json;
};
[[nodiscard]] Glb parts_of_glb(const MeshBytes& file);
// Refuses a glTF that requires an extension which changes shapes, before anything of it is read: without the
// extension its accessors look damaged. `also_optional`: one that packs data is refused where it is only
// used, too.
void check_extensions(const MeshBytes& file, std::string_view json, bool binary, bool also_optional = false);
// tinygltf walks nested values by recursion and keeps some hundred bytes for each value: a file must not nest
// as deep as it likes, nor have more than kMostTriangles values.
void check_json(const MeshBytes& file, std::string_view json, bool binary);

inline constexpr std::string_view kBom = "\xEF\xBB\xBF";  // UTF-8's mark, which a text may begin with

// A finite number from the whole word, whatever the locale; false if it is none.
[[nodiscard]] bool read_number(std::string_view word, double& number);
// Vertices at bit-equal places become one.
void weld(Mesh& mesh);
// Of vertices and triangles: tells whether a mesh is still the one that was used.
[[nodiscard]] std::uint64_t content_hash(const Mesh& mesh);

}  // namespace enc::models
