#include "models/mesh_files/mesh_write.h"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include "core/base/error.h"
#include "models/schema/wording.h"

namespace enc::models {
namespace {

template <class T>
void put(std::string& bytes, const T& value) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), &value, sizeof(T));
  bytes.append(raw.data(), raw.size());
}
void put_point(std::string& bytes, const std::array<double, 3>& v) {
  for (const double x : v) put(bytes, static_cast<float>(x));
}
std::uint32_t count_of(std::size_t n) { return static_cast<std::uint32_t>(n); }

std::string obj(const Mesh& mesh) {
  std::string text = "# metres\n";
  for (const auto& v : mesh.vertices) text += fmt::format("v {} {} {}\n", v[0], v[1], v[2]);
  for (const auto& t : mesh.triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

std::string stl(const Mesh& mesh) {
  std::string bytes = "Encounter, metres";
  bytes.resize(80, ' ');
  put(bytes, count_of(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    put_point(bytes, {0, 0, 0});  // a reader works the normal out
    for (const std::int32_t corner : t) put_point(bytes, mesh.vertices[static_cast<std::size_t>(corner)]);
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}

// glTF wants the box around the positions, as the floats that are written.
std::string box(const Mesh& mesh, bool high) {
  std::string list;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto edge = static_cast<float>(mesh.vertices[0][axis]);
    for (const auto& v : mesh.vertices)
      edge = high ? std::max(edge, static_cast<float>(v[axis])) : std::min(edge, static_cast<float>(v[axis]));
    list += fmt::format("{}{}", axis == 0 ? "" : ",", static_cast<double>(edge));
  }
  return list;
}

std::string glb(const Mesh& mesh) {
  const bool small = mesh.vertices.size() <= 65535;  // indices of two bytes do
  std::string data;
  for (const auto& v : mesh.vertices) put_point(data, v);
  const std::size_t positions = data.size();
  for (const auto& t : mesh.triangles)
    for (const std::int32_t corner : t) {
      if (small)
        put(data, static_cast<std::uint16_t>(corner));
      else
        put(data, corner);
    }
  const std::size_t used = data.size();
  data.resize((data.size() + 3) / 4 * 4, '\0');
  std::string json = fmt::format(
      R"({{"asset":{{"version":"2.0","generator":"Encounter"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],"accessors":[)"
      R"({{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3","min":[{}],"max":[{}]}},)"
      R"({{"bufferView":1,"componentType":{},"count":{},"type":"SCALAR"}}],"bufferViews":[)"
      R"({{"buffer":0,"byteOffset":0,"byteLength":{},"target":34962}},)"
      R"({{"buffer":0,"byteOffset":{},"byteLength":{},"target":34963}}],"buffers":[{{"byteLength":{}}}]}})",
      mesh.vertices.size(), box(mesh, false), box(mesh, true), small ? 5123 : 5125, 3 * mesh.triangles.size(),
      positions, positions, used - positions, data.size());
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string bytes = "glTF";
  put(bytes, std::uint32_t{2});
  put(bytes, count_of(28 + json.size() + data.size()));
  put(bytes, count_of(json.size()));
  bytes += "JSON" + json;
  put(bytes, count_of(data.size()));
  bytes += std::string("BIN\0", 4) + data;
  return bytes;
}

}  // namespace

std::string mesh_bytes(const Mesh& mesh, const std::string& ending) {
  if (mesh.triangles.empty()) throw Error("a mesh without triangles is not written");
  if (ending == ".glb") return glb(mesh);
  if (ending == ".obj") return obj(mesh);
  if (ending == ".stl") return stl(mesh);
  throw Error(fmt::format("a mesh is not written as {}; expected the ending .glb, .obj or .stl; choose one",
                          quoted(ending)));
}

void write_mesh(const Mesh& mesh, const std::string& path, Existing existing) {
  write_file(path, mesh_bytes(mesh, std::filesystem::path(path).extension().string()), existing);
}

}  // namespace enc::models
