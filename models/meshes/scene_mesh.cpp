// The meshes of a scene: found, checked, noted by their hash, and stored in records.
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "core/base/error.h"
#include "models/mesh_files/mesh_check.h"
#include "models/mesh_files/mesh_file.h"
#include "models/schema/wording.h"
#include "models/setup/scene_file.h"
#include "models/shapes/shapes.h"

namespace enc::models {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> meshes_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    const std::string ending = entry.path().extension().string();
    if (ending == ".obj" || ending == ".stl" || ending == ".gltf" || ending == ".glb")
      names.push_back(entry.path().filename().string());
  }
  return names;
}

// A file below a folder, also after all links are resolved; empty if it does not exist.
fs::path below(const fs::path& folder, const std::string& name) {
  std::error_code failed;
  const fs::path root = fs::canonical(folder.empty() ? "." : folder, failed);
  if (failed) return {};
  const fs::path file = fs::canonical(root / name, failed);
  if (failed) return {};
  const fs::path inside = file.lexically_relative(root);
  return inside.empty() || *inside.begin() == ".." ? fs::path() : (folder / name).lexically_normal();
}

fs::path find_mesh(const Setup& setup, const ObjectSpec& object, const fs::path& meshes) {
  const fs::path beside = fs::path(setup.scene_path).parent_path();
  for (const fs::path& folder : {beside, meshes}) {
    if (fs::path found = below(folder, object.mesh); !found.empty()) return found;
  }
  std::vector<std::string> names = meshes_in(beside.empty() ? "." : beside);
  for (std::string& name : meshes_in(meshes)) names.push_back(std::move(name));
  throw Error(fmt::format(
      "{}: there is no mesh {}; expected a file beside the scene or in {}, not outside of them; {}",
      place_of(setup, fmt::format("object.{}.mesh", object.name)), quoted(object.mesh),
      meshes.lexically_normal().string(), advice(object.mesh, names)));
}

std::string hash_text(const Mesh& mesh) { return fmt::format("{:016x}", content_hash(mesh)); }

void compare_hash(const Setup& setup, ObjectSpec& object, const std::string& where) {
  const std::string hash = hash_text(*object.surface);
  if (!object.mesh_hash.empty() && object.mesh_hash != hash)
    throw Error(fmt::format(
        "{}: the mesh in {} has another content: its hash is {}; expected {}; bring the old mesh back, or "
        "write the new hash",
        place_of(setup, fmt::format("object.{}.mesh_hash", object.name)), where, hash,
        models::quoted(object.mesh_hash)));
  object.mesh_hash = hash;
}

// Two counts, the vertices, the triangles: as they are in memory (little-endian, without padding).
std::string packed(const Mesh& mesh) {
  static_assert(sizeof(mesh.vertices[0]) == 24 && sizeof(mesh.triangles[0]) == 12);
  const std::array<std::uint64_t, 2> counts{mesh.vertices.size(), mesh.triangles.size()};
  std::string bytes(sizeof(counts) + 24 * counts[0] + 12 * counts[1], '\0');
  std::memcpy(bytes.data(), counts.data(), sizeof(counts));
  std::memcpy(bytes.data() + sizeof(counts), mesh.vertices.data(), 24 * counts[0]);
  std::memcpy(bytes.data() + sizeof(counts) + 24 * counts[0], mesh.triangles.data(), 12 * counts[1]);
  return bytes;
}

// All its numbers, as they are in memory.
using PackedMaterial = std::array<float, 6>;
std::string packed(const SurfaceMaterial& m) {
  const PackedMaterial all{m.colour[0], m.colour[1], m.colour[2], m.metallic, m.roughness, m.opacity};
  std::string bytes(sizeof(all), '\0');
  std::memcpy(bytes.data(), all.data(), sizeof(all));
  return bytes;
}
SurfaceMaterial material_of(const std::string& bytes, const std::string& name) {
  PackedMaterial all{};
  const auto damaged = [&] { throw Error(name + ": its material is damaged; record the run again"); };
  if (bytes.size() != sizeof(all)) damaged();
  std::memcpy(all.data(), bytes.data(), sizeof(all));
  for (const float share : all)
    if (!(share >= 0.0F && share <= 1.0F)) damaged();
  return {{all[0], all[1], all[2]}, all[3], all[4], all[5]};
}

Mesh unpacked(const std::string& bytes, const std::string& name) {
  std::array<std::uint64_t, 2> counts{};
  const auto damaged = [&] { throw Error(name + ": this mesh is damaged; record the run again"); };
  if (bytes.size() < sizeof(counts)) damaged();
  std::memcpy(counts.data(), bytes.data(), sizeof(counts));
  if (counts[0] > bytes.size() || counts[1] > bytes.size() ||
      bytes.size() != sizeof(counts) + 24 * counts[0] + 12 * counts[1])
    damaged();
  Mesh mesh;
  mesh.vertices.resize(counts[0]);
  mesh.triangles.resize(counts[1]);
  std::memcpy(mesh.vertices.data(), bytes.data() + sizeof(counts), 24 * counts[0]);
  std::memcpy(mesh.triangles.data(), bytes.data() + sizeof(counts) + 24 * counts[0], 12 * counts[1]);
  for (const auto& t : mesh.triangles)
    for (const std::int32_t corner : t)
      if (corner < 0 || static_cast<std::uint64_t>(corner) >= counts[0]) damaged();
  // A run records the result of check_mesh(), which a second check would not change.
  Mesh checked = mesh;
  weld(checked);
  checked = check_mesh(std::move(checked), name).mesh;
  if (checked.vertices != mesh.vertices || checked.triangles != mesh.triangles) damaged();
  return mesh;
}

}  // namespace

void fill_meshes(Setup& setup, const std::string& models_dir) {
  struct MeshEntry {
    std::shared_ptr<const Mesh> mesh;
    std::optional<SurfaceMaterial> material;
  };
  std::map<std::string, MeshEntry> loaded;  // each file once, however many objects name it
  for (ObjectSpec& object : setup.scene.objects) {
    if (object.shape == ShapeKind::box) object.surface = box_surface(object.size);
    if (object.shape != ShapeKind::mesh) continue;
    const std::string path = find_mesh(setup, object, fs::path(models_dir) / "meshes").string();
    MeshEntry& file = loaded[path];
    if (!file.mesh) {
      CheckedMesh checked = load_solid(path);
      setup.notes.insert(setup.notes.end(), checked.notes.begin(), checked.notes.end());
      file = {std::make_shared<const Mesh>(std::move(checked.mesh)), checked.material};
    }
    object.surface = file.mesh;
    object.own_material = file.material;
    compare_hash(setup, object, path);
  }
}

RecordTexts record_texts(const Setup& setup) {
  RecordTexts texts{{"resolved", resolved(setup)}};
  for (const ObjectSpec& object : setup.scene.objects)
    if (object.shape == ShapeKind::mesh && object.surface) {
      texts["mesh:" + object.mesh] = packed(*object.surface);
      if (object.own_material) texts["material:" + object.mesh] = packed(*object.own_material);
    }
  return texts;
}

Setup setup_of(const RecordTexts& texts, const std::string& record_path) {
  const auto text = texts.find("resolved");
  if (text == texts.end())
    throw Error(record_path + ": holds no scene; only records of encounter run can be replayed");
  Setup setup = parse_resolved(text->second, record_path + " (scene)");
  std::map<std::string, std::shared_ptr<const Mesh>> loaded;
  for (ObjectSpec& object : setup.scene.objects) {
    if (object.shape == ShapeKind::box) object.surface = box_surface(object.size);
    if (object.shape != ShapeKind::mesh) continue;
    const auto mesh = texts.find("mesh:" + object.mesh);
    const std::string name = fmt::format("{} ({})", record_path, object.mesh);
    if (mesh == texts.end()) throw Error(name + ": the record does not hold this mesh; record the run again");
    std::shared_ptr<const Mesh>& surface = loaded[object.mesh];
    if (!surface) surface = std::make_shared<const Mesh>(unpacked(mesh->second, name));
    object.surface = surface;
    if (const auto material = texts.find("material:" + object.mesh); material != texts.end())
      object.own_material = material_of(material->second, name);
    compare_hash(setup, object, name);
  }
  return setup;
}

}  // namespace enc::models
