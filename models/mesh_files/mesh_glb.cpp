// What is checked of a glTF file's bytes before tinygltf sees them.
#include <algorithm>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "models/mesh_files/mesh_file.h"
#include "models/schema/wording.h"

namespace enc::models {
namespace {

constexpr int kDeepestJson = 100;

std::size_t word_at(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof(word));
  return word;
}

// Extensions that concern looks alone.
bool only_looks(const std::string& name) {
  return name.starts_with("KHR_materials") || name.starts_with("KHR_texture") ||
         name.starts_with("EXT_texture") || name == "KHR_lights_punctual";
}

// Where the array that follows a key of the outermost object begins; npos where there is none.
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

// How data is stored that an extension packs; empty: it packs none.
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
