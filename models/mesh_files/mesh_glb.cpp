// What is checked of a glTF file's bytes before tinygltf sees them.
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

#include "models/mesh_files/mesh_file.h"

namespace enc::models {
namespace {

constexpr int kDeepestJson = 100;

std::size_t word_at(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof(word));
  return word;
}

// The parts of a .glb: header, JSON chunk and, if there is one, binary chunk. Checked here to the byte,
// because tinygltf 2.7 reads up to 8 bytes beyond a chunk that claims to be longer than the file.
}  // namespace

std::string_view json_of_glb(const MeshBytes& file) {
  const std::string& bytes = file.bytes;
  const auto need = [&](bool good, std::size_t byte, const std::string& what) {
    if (!good) file.fail_at_byte(byte, what + "; export the file again");
  };
  need(bytes.size() >= 4 && bytes.starts_with("glTF"), 0, "this is no .glb; expected the letters glTF");
  need(bytes.size() >= 20, bytes.size(), "the file ends in its header; expected at least 20 bytes");
  need(word_at(bytes, 4) == 2, 4, fmt::format("glTF version {}; expected version 2", word_at(bytes, 4)));
  need(word_at(bytes, 8) == bytes.size(), 8,
       fmt::format("the header says {} bytes, but the file has {}; expected the same", word_at(bytes, 8),
                   bytes.size()));
  const std::size_t json = word_at(bytes, 12);
  need(word_at(bytes, 16) == 0x4e4f534a, 16, "the first chunk is not JSON; expected JSON");
  need(json >= 1 && json <= bytes.size() - 20, 12,
       fmt::format("a JSON chunk of {} bytes; expected what the file holds", json));
  for (std::size_t at = 20 + json; at < bytes.size();) {
    need(bytes.size() - at >= 8, at, "the file ends in the head of a chunk; expected 8 bytes");
    const std::size_t size = word_at(bytes, at);
    need(size <= bytes.size() - at - 8, at,
         fmt::format("a chunk of {} bytes; expected what the file holds", size));
    at += 8 + size;
  }
  return std::string_view(bytes).substr(20, json);
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
