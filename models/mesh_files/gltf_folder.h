// The files that a glTF reader may open: those in its own folder. tinygltf asks here before it opens a file.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace enc::models {

inline constexpr std::uintmax_t kMostBuffers = (std::uintmax_t{1} << 31) - 1;  // total of all buffer files

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
    if (asked.starts_with("./")) return false;  // because tinygltf then also looks in the working directory
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
