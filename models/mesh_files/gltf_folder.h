// The files that reading a glTF may open: those in its own folder. tinygltf asks here before it opens one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace enc::models {

inline constexpr std::uintmax_t kMostBuffers = (std::uintmax_t{1} << 31) - 1;  // of all buffer files

// What tinygltf may read: regular files in the mesh's own folder. Images are never read.
struct GltfFolder {
  std::filesystem::path root;  // canonical
  std::string refused;         // the first file that was asked for outside
  std::uintmax_t read = 0;     // bytes; one file may be named any number of times

  static bool is_image(const std::filesystem::path& path) {
    static const std::vector<std::string> kEndings{".png", ".jpg",  ".jpeg", ".webp",
                                                   ".ktx", ".ktx2", ".dds",  ".basis"};
    return std::find(kEndings.begin(), kEndings.end(), path.extension().string()) != kEndings.end();
  }
  bool may_read(const std::string& asked) {
    if (asked.starts_with("./")) return false;  // tinygltf then looks in the working directory, too
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

}  // namespace enc::models
