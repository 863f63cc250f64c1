#include "models/mesh_files/mesh_file.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include <fmt/format.h>

#include "core/base/counted.h"
#include "core/base/error.h"
#include "models/files.h"
#include "models/schema/wording.h"

namespace enc::models {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 31;

std::string bytes_of(const std::string& path) {
  const auto refuse = [&](const std::string& why) {
    throw Error(
        fmt::format("{}:1:1: cannot read this mesh: {}; expected an .obj, .stl, .gltf or .glb file; "
                    "give the path of one",
                    path, why));
  };
  std::error_code failed;
  const fs::file_status status = fs::status(path, failed);
  if (!fs::exists(status)) refuse("there is no such file");
  if (fs::is_directory(status)) refuse("it is a folder");
  if (!fs::is_regular_file(status)) refuse("it is no regular file");
  const std::uintmax_t size = fs::file_size(path, failed);
  if (failed) refuse(failed.message());
  if (size == 0) refuse("it is empty");
  if (size >= kMostBytes) refuse("it has 2 GiB or more");
  note_input(path);
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string bytes(size, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!file) refuse(errno != 0 ? std::strerror(errno) : "it became shorter meanwhile");
  return bytes;
}

std::string extension_of(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

// Zeros or the end mark of DOS (1A) behind a text. Gives how many bytes that were.
std::size_t drop_padding(std::string& text) {
  const std::size_t end = text.find_last_not_of(std::string_view("\0\x1a", 2)) + 1;  // npos + 1 is 0
  const std::size_t padding = text.size() - end;
  if (padding > kMostRest || end == 0) return 0;
  text.resize(end);
  return padding;
}

std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0xff51afd7ed558ccdULL;
  return hash ^ (hash >> 32);
}
std::uint64_t hash_of(const std::array<double, 3>& v, std::uint64_t hash = 0x9e3779b97f4a7c15ULL) {
  for (const double x : v) hash = mixed(hash, std::bit_cast<std::uint64_t>(x));
  return hash;
}

}  // namespace

void MeshBytes::fail_at_byte(std::size_t byte, const std::string& what) const {
  throw Error(fmt::format("{}: byte {}: {}", path, byte, what));
}

void MeshBytes::fail_at_text(std::size_t byte, const std::string& what) const {
  const std::string_view before = std::string_view(bytes).substr(0, std::min(byte, bytes.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t start = before.rfind('\n') + 1;  // npos + 1 is 0
  throw Error(fmt::format("{}:{}:{}: {}", path, line, before.size() - start + 1, what));
}

std::string rest_note(const MeshBytes& file, std::size_t rest, const std::string& after) {
  return fmt::format("{}: passed over {} after {}", file.path, counted(rest, "byte"), after);
}

bool read_number(std::string_view word, double& number) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, bad] = std::from_chars(word.data(), word.data() + word.size(), number);
  return bad == std::errc() && end == word.data() + word.size() && std::isfinite(number);
}

void weld(Mesh& mesh) {
  // Another one in each process, so that no file can be made whose vertices all fall into one slot.
  static const std::uint64_t kKey = [] {
    std::random_device random;
    return (std::uint64_t{random()} << 32U) | random();
  }();
  std::vector<std::int32_t> slots(std::bit_ceil(2 * mesh.vertices.size() + 1), -1);
  std::vector<std::int32_t> now(mesh.vertices.size());
  std::int32_t kept = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    std::array<double, 3> v = mesh.vertices[i];
    for (double& x : v) x += 0.0;  // -0 is at the same place as 0
    std::size_t slot = hash_of(v, kKey) & (slots.size() - 1);
    while (slots[slot] >= 0 && mesh.vertices[static_cast<std::size_t>(slots[slot])] != v)
      slot = (slot + 1) & (slots.size() - 1);
    if (slots[slot] < 0) {
      slots[slot] = kept;
      mesh.vertices[static_cast<std::size_t>(kept++)] = v;  // never beyond i
    }
    now[i] = slots[slot];
  }
  mesh.vertices.resize(static_cast<std::size_t>(kept));
  for (auto& triangle : mesh.triangles)
    for (std::int32_t& corner : triangle) corner = now[static_cast<std::size_t>(corner)];
}

std::uint64_t content_hash(const Mesh& mesh) {
  std::uint64_t hash = mixed(mesh.vertices.size(), mesh.triangles.size());
  for (const auto& v : mesh.vertices) hash = mixed(hash, hash_of(v));
  for (const auto& t : mesh.triangles)
    for (const std::int32_t corner : t) hash = mixed(hash, static_cast<std::uint64_t>(corner));
  return hash;
}

FileMesh load_faces(const std::string& path) {
  std::string bytes = bytes_of(path);
  const MeshBytes file{path, bytes};
  const std::string extension = extension_of(path);
  const std::size_t padding = extension == ".obj" || extension == ".gltf" ? drop_padding(bytes) : 0;
  FileMesh read;
  if (extension == ".obj") {
    read = read_obj(file);
  } else if (extension == ".stl") {
    read = read_stl(file);
  } else if (extension == ".gltf" || extension == ".glb") {
    read = read_gltf(file, extension == ".glb");
  } else {
    throw Error(
        fmt::format("{}:1:1: {} is no ending of a mesh file; expected .obj, .stl, .gltf or .glb; "
                    "rename or convert it",
                    path, quoted(extension)));
  }
  if (read.mesh.triangles.empty())
    throw Error(
        fmt::format("{}:1:1: the file has no triangles; expected a closed surface; export it again", path));
  if (padding > 0) read.notes.push_back(rest_note(file, padding, "the end of the text"));
  weld(read.mesh);
  return read;
}

Mesh load_mesh(const std::string& path) { return load_faces(path).mesh; }

}  // namespace enc::models
