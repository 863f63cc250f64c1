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

#include "core/base/error.h"
#include "core/base/words.h"
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

// Removes zeros or DOS's end mark (1A) behind a text. Returns the number of bytes removed.
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
  // A random key for each process, so that no file can be crafted whose vertices all fall into one slot.
  static const std::uint64_t kKey = [] {
    std::random_device random;
    return (std::uint64_t{random()} << 32U) | random();
  }();
  std::vector<std::int32_t> slots(std::bit_ceil(2 * mesh.vertices.size() + 1), -1);
  std::vector<std::int32_t> now(mesh.vertices.size());
  std::int32_t kept = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    std::array<double, 3> v = mesh.vertices[i];
    for (double& x : v) x += 0.0;  // -0 and 0 are the same position
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
    put_point(bytes, {0, 0, 0});  // readers compute the normal
    for (const std::int32_t corner : t) put_point(bytes, mesh.vertices[static_cast<std::size_t>(corner)]);
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}

// glTF requires the box of the positions, as the floats that are written.
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
  const bool small = mesh.vertices.size() <= 65535;  // two-byte indices suffice
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

void write_mesh(const Mesh& mesh, const std::string& path, OverwritePolicy existing) {
  write_file(path, mesh_bytes(mesh, std::filesystem::path(path).extension().string()), existing);
}

namespace {

constexpr double kFarthest = 1e6;  // m: beyond, squares of double cannot separate a mesh from a point

class PointsReader {
 public:
  PointsReader(const std::string& text, const std::string& path) : path_(path), text_(text) {
    if (line() != "x_m,y_m,z_m")
      fail(1, fmt::format("the header is {}; expected x_m,y_m,z_m; write it in the first line",
                          models::quoted(line_)));
  }

  // Reads the next point. False at the end of the file.
  bool next(Vec3& point) {
    if (at_ >= text_.size()) return false;
    if (line().empty()) {
      if (text_.find_first_not_of("\r\n", start_) != std::string::npos)
        fail(1, "an empty line; expected three numbers; remove it");
      return false;
    }
    std::size_t from = 0;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const std::size_t to = std::min(line_.find(',', from), line_.size());
      if (!read_number(std::string_view(line_).substr(from, to - from), point[i]))
        fail(from + 1, fmt::format("{} is no number; expected x,y,z in metres; correct the line",
                                   models::quoted(line_.substr(from, to - from))));
      if (std::abs(point[i]) > kFarthest)
        fail(from + 1, fmt::format("{} m is farther than {:g} m; expected x,y,z in metres; correct the line",
                                   line_.substr(from, to - from), kFarthest));
      from = std::min(to + 1, line_.size());
      if (i == 2 && to < line_.size())
        fail(to + 1, "more than three numbers; expected x,y,z; correct the line");
    }
    return true;
  }

 private:
  const std::string& line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    start_ = at_;
    line_ = text_.substr(at_, end - at_);
    if (line_.ends_with('\r')) line_.pop_back();
    at_ = end + 1;
    ++number_;
    return line_;
  }
  [[noreturn]] void fail(std::size_t column, const std::string& what) const {
    throw Error(fmt::format("{}:{}:{}: {}", path_, std::max<std::size_t>(number_, 1), column, what));
  }

  const std::string &path_, &text_;
  std::string line_;
  std::size_t at_ = 0, start_ = 0, number_ = 0;
};

}  // namespace

std::vector<Vec3> parse_places(const std::string& text, const std::string& path) {
  PointsReader reader(text, path);
  std::vector<Vec3> all;
  for (Vec3 place; reader.next(place);) all.push_back(place);
  return all;
}

}  // namespace enc::models
