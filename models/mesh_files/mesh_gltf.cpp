// glTF 2.0 (.gltf, .glb): tinygltf reads JSON and buffers, everything after that is checked here. Positions
// go through the node tree. Animations and images are skipped, and one material is read.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/format.h>
#include <tiny_gltf.h>

#include "models/mesh_files/mesh_file.h"
#include "models/schema/wording.h"

namespace enc::models {
namespace {

// ---- The files that a glTF reader may open: only those in its own folder. tinygltf calls these functions
// before it opens one.

constexpr std::uintmax_t kMostBuffers = (std::uintmax_t{1} << 31) - 1;  // total of all buffer files

// Rules for tinygltf: it may read regular files in the mesh's own folder, and never images.
struct GltfFolder {
  std::filesystem::path root;  // canonical
  std::string refused;         // the first file requested outside of the folder
  std::uintmax_t read = 0;     // bytes; a file may be named several times

  static bool is_image(const std::filesystem::path& path) {
    static const std::vector<std::string> kEndings{".png", ".jpg",  ".jpeg", ".webp",
                                                   ".ktx", ".ktx2", ".dds",  ".basis"};
    return std::find(kEndings.begin(), kEndings.end(), path.extension().string()) != kEndings.end();
  }
  bool may_read(const std::string& asked) {
    if (asked.starts_with("./")) return false;  // otherwise tinygltf also looks in the working directory
    std::error_code failed;
    const std::filesystem::path path = std::filesystem::weakly_canonical(asked, failed);
    const std::filesystem::path inside = failed ? std::filesystem::path("..") : path.lexically_relative(root);
    const bool absolute = asked.starts_with(root.string() + "//");
    if (absolute || inside.empty() || *inside.begin() == "..") {
      if (refused.empty()) refused = asked;
      return false;
    }
    return !is_image(path) && std::filesystem::is_regular_file(path, failed);
  }
  bool too_much() const { return read > kMostBuffers; }
  bool may_read_whole(const std::string& asked) {
    std::error_code failed;
    if (too_much() || !may_read(asked)) return false;
    const std::uintmax_t size = std::filesystem::file_size(asked, failed);
    read += failed ? 0 : size;
    return !failed && !too_much();
  }
};

tinygltf::FsCallbacks callbacks(GltfFolder& folder) {
  tinygltf::FsCallbacks calls{};
  // expands neither ~ nor $VARIABLE
  calls.ExpandFilePath = [](const std::string& path, void*) { return path; };
  calls.FileExists = [](const std::string& path, void* user) {
    return static_cast<GltfFolder*>(user)->may_read(path);
  };
  calls.ReadWholeFile = [](std::vector<unsigned char>* out, std::string* error, const std::string& path,
                           void* user) {
    return static_cast<GltfFolder*>(user)->may_read_whole(path) &&
           tinygltf::ReadWholeFile(out, error, path, nullptr);
  };
  calls.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
  };
  calls.user_data = &folder;
  return calls;
}

bool no_image(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
  return true;
}

// Puts tinygltf's message on one line, with the position if it names one.
[[noreturn]] void fail_parse(const MeshBytes& file, std::string_view json, bool binary, std::string words) {
  while (!words.empty() && (words.back() == '\n' || words.back() == ' ')) words.pop_back();
  words = printable(std::move(words));
  if (words.size() > 200) words = words.substr(0, 200) + "...";
  if (words.empty()) words = "no reason given";
  // nlohmann's JSON reports "... at line 3, column 7: ...".
  std::size_t line = 1, column = 1;
  const std::size_t said = words.find("at line ");
  const bool placed = said != std::string::npos &&
                      std::sscanf(words.c_str() + said, "at line %zu, column %zu", &line, &column) == 2;
  std::size_t at = 0;
  for (; placed && line > 1 && at < json.size(); ++at)
    if (json[at] == '\n') --line;
  at = std::min(at + column - 1, json.size());
  const std::string what =
      fmt::format("this glTF cannot be read: {}; expected glTF 2.0; export the file again", words);
  if (binary) file.fail_at_byte(20 + at, what);
  file.fail_at_text(at, what);
}

class GltfReader {
 public:
  GltfReader(const MeshBytes& file, bool binary) : file_(file), binary_(binary) {}

  FileMesh read() {
    parse();
    walk();
    return {std::move(mesh_), {}, std::move(notes_), material()};
  }

 private:
  // The position in the file is lost here, but the part of the file is known.
  [[noreturn]] void fail(const std::string& what) const {
    if (binary_) file_.fail_at_byte(20, what);
    file_.fail_at_text(0, what);
  }
  void need(bool good, const char* list, std::size_t index, const char* what) const {
    if (!good) fail(fmt::format("{}[{}] {}; export the file again", list, index, what));
  }
  template <class T>
  const T& part(const std::vector<T>& list, const char* name, int index) const {
    if (index < 0 || static_cast<std::size_t>(index) >= list.size())
      fail(fmt::format("{}[{}] is not there; expected one of {}; export the file again", name, index,
                       list.size()));
    return list[static_cast<std::size_t>(index)];
  }

  // The library's own parser, into model_.
  bool load(GltfFolder& folder, unsigned size, std::string& error) {
    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks(callbacks(folder));
    loader.SetImageLoader(no_image, nullptr);
    std::string warning;
    try {
      return binary_ ? loader.LoadBinaryFromMemory(&model_, &error, &warning,
                                                   reinterpret_cast<const unsigned char*>(file_.bytes.data()),
                                                   size, folder.root.string())
                     : loader.LoadASCIIFromString(&model_, &error, &warning, file_.bytes.data(), size,
                                                  folder.root.string());
    } catch (const std::exception& e) {  // thrown by its JSON for values of an unexpected type
      error += e.what();
      return false;
    }
  }

  void parse() {
    const Glb glb = binary_ ? parts_of_glb(file_) : Glb{file_.bytes.size(), file_.bytes};
    const std::string_view json = glb.json;
    check_json(file_, json, binary_);
    check_extensions(file_, json, binary_);
    if (const std::size_t rest = file_.bytes.size() - glb.length; rest > 0)
      notes_.push_back(rest_note(file_, rest, "the length in the header"));
    std::error_code none;
    const std::filesystem::path parent = std::filesystem::path(file_.path).parent_path();
    GltfFolder folder{std::filesystem::canonical(parent.empty() ? "." : parent, none), {}};
    std::string error;
    const bool good = load(folder, static_cast<unsigned>(glb.length), error);
    if (!folder.refused.empty()) {
      const std::string asked = folder.refused.substr(folder.root.string().size() + 1);
      fail(fmt::format(
          "the file wants to read {}, which is outside of its folder; expected files beside it; put a "
          "copy there",
          models::quoted(asked)));
    }
    if (folder.too_much())
      fail(
          "its buffers hold 2 GiB or more together; expected less; name each once, or make the mesh coarser");
    if (!good) check_extensions(file_, json, binary_, true);
    if (!good) fail_parse(file_, json, binary_, error);
    if (model_.asset.version != "2.0" && !model_.asset.version.starts_with("2."))
      fail(fmt::format("asset.version is {}; expected 2.0; export the file again",
                       models::quoted(model_.asset.version)));
  }

  // The scene's nodes; without a scene, all nodes that are no other node's children.
  std::vector<int> roots() const {
    const std::size_t count = model_.nodes.size();
    if (!model_.scenes.empty()) return part(model_.scenes, "scenes", std::max(model_.defaultScene, 0)).nodes;
    std::vector<bool> child(count, false);
    for (const tinygltf::Node& node : model_.nodes)
      for (const int c : node.children)
        if (c >= 0 && static_cast<std::size_t>(c) < count) child[static_cast<std::size_t>(c)] = true;
    std::vector<int> found;
    for (std::size_t i = 0; i < count; ++i)
      if (!child[i]) found.push_back(static_cast<int>(i));
    if (count > 0 && found.empty())
      fail("nodes[0] is its own descendant; expected a tree of nodes; export the file again");
    return found;
  }

  // Walks the node tree of the scene from the roots, without recursion. A tree contains each node once.
  void walk() {
    const std::size_t count = model_.nodes.size();
    struct Step {
      int node;
      Eigen::Matrix4d above;
    };
    std::vector<Step> steps;
    for (const int root : roots()) steps.push_back({root, Eigen::Matrix4d::Identity()});
    std::vector<bool> met(count, false);
    while (!steps.empty()) {
      const Step step = steps.back();
      steps.pop_back();
      const tinygltf::Node& node = part(model_.nodes, "nodes", step.node);
      const auto index = static_cast<std::size_t>(step.node);
      need(!met[index], "nodes", index, "is met twice (a cycle, or two parents); expected a tree of nodes");
      met[index] = true;
      const Eigen::Matrix4d placed = step.above * transform(node, index);
      need(placed.allFinite(), "nodes", index, "is placed beyond all numbers; expected finite transforms");
      need(node.skin < 0, "nodes", index, "has a skin; expected a rigid mesh; apply the skeleton");
      if (node.mesh >= 0) add_mesh(static_cast<std::size_t>(node.mesh), placed);
      for (const int child : node.children) steps.push_back({child, placed});
      if (steps.size() > count)
        fail("the nodes have more children than there are nodes; expected a tree; export the file again");
    }
    if (model_.scenes.empty() && count == 0)
      for (std::size_t i = 0; i < model_.meshes.size(); ++i) add_mesh(i, Eigen::Matrix4d::Identity());
  }

  Eigen::Matrix4d transform(const tinygltf::Node& node, std::size_t index) const {
    const auto sized = [&](const std::vector<double>& list, std::size_t size, const char* what) {
      need(list.empty() || list.size() == size, "nodes", index, what);
      return !list.empty();
    };
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    if (sized(node.matrix, 16, "has a wrong 'matrix'; expected 16 numbers")) {
      m = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());  // columns, as in the file
      need(m.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1)), "nodes", index,
           "has a 'matrix' with a perspective; expected a last row of 0 0 0 1");
      return m;
    }
    Eigen::Vector3d scale = Eigen::Vector3d::Ones();
    Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
    if (sized(node.scale, 3, "has a wrong 'scale'; expected 3 numbers"))
      scale = Eigen::Vector3d(node.scale.data());
    if (sized(node.rotation, 4, "has a wrong 'rotation'; expected 4 numbers")) {
      q.coeffs() = Eigen::Vector4d(node.rotation.data());  // x, y, z, w
      need(std::abs(q.norm() - 1.0) < 1e-3, "nodes", index,
           "has a 'rotation' that is none; expected a unit quaternion");
      q.normalize();
    }
    m.topLeftCorner<3, 3>() = q.toRotationMatrix() * scale.asDiagonal();
    if (sized(node.translation, 3, "has a wrong 'translation'; expected 3 numbers"))
      m.topRightCorner<3, 1>() = Eigen::Vector3d(node.translation.data());
    return m;
  }

  // The data of an accessor, checked to lie within its buffer.
  struct View {
    const unsigned char* data;
    std::size_t count, stride;
    int component;
  };
  View view_of(int index, int type, const char* what) const {
    const tinygltf::Accessor& a = part(model_.accessors, "accessors", index);
    const auto i = static_cast<std::size_t>(index);
    need(!a.sparse.isSparse, "accessors", i, "is sparse; expected plain data");
    need(a.bufferView >= 0, "accessors", i, "has no bufferView (compressed?); expected plain data");
    need(a.type == type && !a.normalized, "accessors", i, what);
    const tinygltf::BufferView& v = part(model_.bufferViews, "bufferViews", a.bufferView);
    const std::size_t buffer = part(model_.buffers, "buffers", v.buffer).data.size();
    const auto component = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(a.componentType));
    need(component > 0, "accessors", i, "has an unknown componentType; expected one of glTF 2.0");
    const std::size_t size = static_cast<std::size_t>(component) * (type == TINYGLTF_TYPE_VEC3 ? 3 : 1);
    const std::size_t stride = v.byteStride != 0 ? v.byteStride : size;
    need(stride >= size && stride <= 252, "accessors", i,
         "has a wrong byteStride; expected the element's size to 252");
    need(v.byteOffset <= buffer && v.byteLength <= buffer - v.byteOffset, "bufferViews",
         static_cast<std::size_t>(a.bufferView), "reaches beyond its buffer; expected it within");
    const bool fits = a.count >= 1 && a.byteOffset <= v.byteLength && size <= v.byteLength - a.byteOffset &&
                      a.count - 1 <= (v.byteLength - a.byteOffset - size) / stride;
    need(fits, "accessors", i,
         "has no or more elements than its bufferView holds; expected a count that fits");
    return {model_.buffers[static_cast<std::size_t>(v.buffer)].data.data() + v.byteOffset + a.byteOffset,
            a.count, stride, a.componentType};
  }

  void add_mesh(std::size_t index, const Eigen::Matrix4d& placed) {
    for (const tinygltf::Primitive& p : part(model_.meshes, "meshes", static_cast<int>(index)).primitives) {
      if (++primitives_ > kMostTriangles)
        fail(fmt::format("its nodes have more than {} primitives; expected fewer; export the mesh as one",
                         kMostTriangles));
      if (p.mode == TINYGLTF_MODE_POINTS || p.mode == TINYGLTF_MODE_LINE ||
          p.mode == TINYGLTF_MODE_LINE_LOOP || p.mode == TINYGLTF_MODE_LINE_STRIP)
        continue;  // no surface
      need(p.mode == TINYGLTF_MODE_TRIANGLES || p.mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
               p.mode == TINYGLTF_MODE_TRIANGLE_FAN,
           "meshes", index, "has an unknown 'mode'; expected 0 to 6");
      need(p.targets.empty(), "meshes", index, "has morph targets; expected one fixed shape; apply them");
      const auto position = p.attributes.find("POSITION");
      need(position != p.attributes.end(), "meshes", index, "has a primitive without POSITION; expected one");
      const std::size_t first = mesh_.vertices.size();
      const std::size_t count = add_vertices(
          view_of(position->second, TINYGLTF_TYPE_VEC3, "is no POSITION; expected VEC3 of float"),
          position->second, placed);
      std::vector<std::int32_t> corners;
      if (p.indices >= 0) {
        corners = indices(
            view_of(p.indices, TINYGLTF_TYPE_SCALAR, "are no indices; expected SCALAR of whole numbers"),
            p.indices, count);
      } else {
        for (std::size_t i = 0; i < count; ++i) corners.push_back(static_cast<std::int32_t>(i));
      }
      const std::size_t before = mesh_.triangles.size();
      add_triangles(p.mode, corners, static_cast<std::int32_t>(first),
                    placed.topLeftCorner<3, 3>().determinant() < 0.0, index);
      covered_[p.material] += mesh_.triangles.size() - before;
    }
  }

  std::size_t add_vertices(const View& view, int accessor, const Eigen::Matrix4d& placed) {
    const auto index = static_cast<std::size_t>(accessor);
    need(view.component == TINYGLTF_COMPONENT_TYPE_FLOAT, "accessors", index,
         "is no POSITION; expected VEC3 of float");
    if (view.count > 3 * kMostTriangles - std::min(mesh_.vertices.size(), 3 * kMostTriangles))
      fail(fmt::format("more than {} vertices; expected fewer; make the mesh coarser", 3 * kMostTriangles));
    const Eigen::Matrix3d turn = placed.topLeftCorner<3, 3>();
    const Eigen::Vector3d shift = placed.topRightCorner<3, 1>();
    for (std::size_t i = 0; i < view.count; ++i) {
      std::array<float, 3> raw{};
      std::memcpy(raw.data(), view.data + i * view.stride, sizeof(raw));  // the data may be unaligned
      const Eigen::Vector3d at = turn * Eigen::Vector3f(raw.data()).cast<double>() + shift;
      if (!at.allFinite())
        fail(fmt::format(
            "vertex {} of accessors[{}] is not finite; expected finite positions; export the file again", i,
            index));
      mesh_.vertices.push_back({at.x(), at.y(), at.z()});
    }
    return view.count;
  }

  std::vector<std::int32_t> indices(const View& view, int accessor, std::size_t vertices) const {
    const bool whole = view.component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                       view.component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                       view.component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    need(whole, "accessors", static_cast<std::size_t>(accessor),
         "are no indices; expected unsigned bytes, shorts or ints");
    const std::size_t size = view.component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE    ? 1
                             : view.component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? 2
                                                                                        : 4;
    std::vector<std::int32_t> list(view.count);
    for (std::size_t i = 0; i < view.count; ++i) {
      std::uint32_t value = 0;  // little-endian: the low byte is first
      std::memcpy(&value, view.data + i * view.stride, size);
      if (value >= vertices)
        fail(
            fmt::format("index {} of accessors[{}] is {}; expected less than {}, the number of vertices; "
                        "export the file again",
                        i, accessor, value, vertices));
      list[i] = static_cast<std::int32_t>(value);
    }
    return list;
  }

  void add_triangles(int mode, const std::vector<std::int32_t>& c, std::int32_t first, bool mirrored,
                     std::size_t mesh) {
    const bool list = mode == TINYGLTF_MODE_TRIANGLES;
    need(c.size() >= 3 && (!list || c.size() % 3 == 0), "meshes", mesh,
         "has a cut-off triangle; expected 3 corners for each");
    const std::size_t count = list ? c.size() / 3 : c.size() - 2;
    if (count > kMostTriangles - std::min(mesh_.triangles.size(), kMostTriangles))
      fail(fmt::format("more than {} triangles; expected fewer; make the mesh coarser", kMostTriangles));
    for (std::size_t i = 0; i < count; ++i) {
      std::array<std::int32_t, 3> t{};
      if (list) {
        t = {c[3 * i], c[3 * i + 1], c[3 * i + 2]};
      } else if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
        t = {c[i + 1], c[i + 2], c[0]};
      } else {
        t = {c[i], c[i + 1 + i % 2], c[i + 2 - i % 2]};  // every second triangle has the opposite order
      }
      if (mirrored) std::swap(t[1], t[2]);
      for (std::int32_t& corner : t) corner += first;
      mesh_.triangles.push_back(t);
    }
  }

  // The material of most triangles. An unusable texture is skipped and is no reason to refuse a mesh.
  [[nodiscard]] std::optional<SurfaceMaterial> material() const {
    const auto most = std::max_element(covered_.begin(), covered_.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most == covered_.end() || most->first < 0) return {};
    if (static_cast<std::size_t>(most->first) >= model_.materials.size()) return {};
    const tinygltf::PbrMetallicRoughness& pbr =
        model_.materials[static_cast<std::size_t>(most->first)].pbrMetallicRoughness;
    const std::vector<double>& colour = pbr.baseColorFactor;
    if (colour.size() != 4) return {};
    const auto share = [](double value) {  // NaN gives 0
      return static_cast<float>(value > 0.0 ? std::min(value, 1.0) : 0.0);
    };
    SurfaceMaterial material;
    for (std::size_t i = 0; i < 3; ++i)  // the file's colours are linear in light
      material.colour[i] = std::pow(share(colour[i]), 1.0F / 2.2F);
    // OPAQUE, the default, ignores the fourth number; MASK shows values above its cut-off.
    const tinygltf::Material& whole = model_.materials[static_cast<std::size_t>(most->first)];
    if (whole.alphaMode == "BLEND") material.opacity = share(colour[3]);
    if (whole.alphaMode == "MASK" && colour[3] < whole.alphaCutoff) return {};
    material.metallic = share(pbr.metallicFactor);
    material.roughness = share(pbr.roughnessFactor);
    return material;
  }

  const MeshBytes& file_;
  bool binary_;
  tinygltf::Model model_;
  std::map<int, std::size_t> covered_;  // triangles of each material; -1: none
  std::size_t primitives_ = 0;          // of all nodes
  Mesh mesh_;
  std::vector<std::string> notes_;
};

}  // namespace

FileMesh read_gltf(const MeshBytes& file, bool binary) { return GltfReader(file, binary).read(); }

// ---- Checks of a glTF file's bytes before tinygltf reads them.

namespace {

constexpr int kDeepestJson = 100;

std::size_t word_at(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof(word));
  return word;
}

// Extensions that only affect the look.
bool only_looks(const std::string& name) {
  return name.starts_with("KHR_materials") || name.starts_with("KHR_texture") ||
         name.starts_with("EXT_texture") || name == "KHR_lights_punctual";
}

// Start of the array behind a key of the outermost object; npos if the key is missing.
std::size_t array_of(std::string_view json, std::string_view key) {
  int depth = 0;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (c != '"') continue;
    const std::size_t begin = ++i;
    while (i < json.size() && json[i] != '"') i += json[i] == '\\' ? 2 : 1;
    if (depth != 1 || json.substr(begin, std::min(i, json.size()) - begin) != key) continue;
    const std::size_t colon = json.find_first_not_of(" \t\r\n", i + 1);
    if (colon >= json.size() || json[colon] != ':') continue;
    const std::size_t array = json.find_first_not_of(" \t\r\n", colon + 1);
    if (array < json.size() && json[array] == '[') return array;
  }
  return std::string_view::npos;
}

std::vector<std::string> names_in(std::string_view json, std::string_view key) {
  std::vector<std::string> names;
  std::size_t i = array_of(json, key);
  for (; i < json.size() && json[i] != ']'; ++i) {
    if (json[i] != '"') continue;
    const std::size_t end = std::min(json.find('"', i + 1), json.size());
    names.emplace_back(json.substr(i + 1, end - i - 1));
    i = end;
  }
  return names;
}

// Data packing of an extension; empty: it packs no data.
std::string packing(const std::string& extension) {
  const auto has = [&](const char* part) { return extension.find(part) != std::string::npos; };
  return has("draco")          ? "compressed with Draco"
         : has("meshopt")      ? "compressed with meshopt"
         : has("quantization") ? "quantised"
                               : "";
}

}  // namespace

Glb parts_of_glb(const MeshBytes& file) {
  const std::string& bytes = file.bytes;
  const auto need = [&](bool good, std::size_t byte, const std::string& what) {
    if (!good) file.fail_at_byte(byte, what + "; export the file again");
  };
  need(bytes.size() >= 4 && bytes.starts_with("glTF"), 0, "this is no .glb; expected the letters glTF");
  need(bytes.size() >= 20, bytes.size(), "the file ends in its header; expected at least 20 bytes");
  need(word_at(bytes, 4) == 2, 4, fmt::format("glTF version {}; expected version 2", word_at(bytes, 4)));
  const std::size_t length = word_at(bytes, 8);
  need(length >= 20 && length <= bytes.size() && bytes.size() - length <= kMostRest, 8,
       fmt::format("the header says {} bytes, but the file has {}; expected the same", length, bytes.size()));
  const std::size_t json = word_at(bytes, 12);
  need(word_at(bytes, 16) == 0x4e4f534a, 16, "the first chunk is not JSON; expected JSON");
  need(json >= 1 && json <= length - 20, 12,
       fmt::format("a JSON chunk of {} bytes; expected what the file holds", json));
  for (std::size_t at = 20 + json; at < length;) {
    need(length - at >= 8, at, "the file ends in the head of a chunk; expected 8 bytes");
    const std::size_t size = word_at(bytes, at);
    need(size <= length - at - 8, at, fmt::format("a chunk of {} bytes; expected what the file holds", size));
    at += 8 + size;
  }
  return {length, std::string_view(bytes).substr(20, json)};
}

void check_extensions(const MeshBytes& file, std::string_view json, bool binary, bool also_optional) {
  const auto refuse = [&](std::string_view list, const std::string& what) {
    const std::size_t at = array_of(json, list);
    if (binary) file.fail_at_byte(20 + at, what);
    file.fail_at_text(at, what);
  };
  for (const std::string_view list : {"extensionsRequired", "extensionsUsed"}) {
    if (list == "extensionsUsed" && !also_optional) return;
    for (const std::string& name : names_in(json, list)) {
      if (const std::string packed = packing(name); !packed.empty())
        refuse(list,
               fmt::format("the mesh is {} ({}); expected plain glTF 2.0; export it without compression",
                           packed, quoted(name)));
      if (list == "extensionsRequired" && !only_looks(name))
        refuse(list,
               fmt::format("the file requires the extension {}; expected plain glTF 2.0; export it without",
                           quoted(name)));
    }
  }
}

void check_json(const MeshBytes& file, std::string_view json, bool binary) {
  const auto fail = [&](std::size_t i, const std::string& what) {
    if (binary) file.fail_at_byte(20 + i, what);
    file.fail_at_text(i, what);
  };
  int depth = 0;
  std::size_t values = 1;
  bool quoted = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (quoted && c == '\\') {
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && (c == '[' || c == '{' || c == ',')) {
      if (c != ',' && ++depth > kDeepestJson)
        fail(i, fmt::format("JSON nested {} deep; expected at most {}; export the file again", depth,
                            kDeepestJson));
      if (++values > kMostTriangles)
        fail(i, fmt::format("JSON of more than {} values; expected fewer; export the mesh as one, as .glb",
                            kMostTriangles));
    } else if (!quoted && (c == ']' || c == '}')) {
      --depth;
    }
  }
}

}  // namespace enc::models
