// Finds the image pairs of a folder, by the sides in the names of the images or of two folders in it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace enc::images {

struct PairFiles {
  std::string left, right;  // side_by_side: both are one file
};
struct FoundPairs {
  std::vector<PairFiles> pairs;  // in natural order
  std::size_t others = 0;        // further images whose names state no side
};

// Images of a folder, excluding its subfolders. Throws Error if it cannot be read.
[[nodiscard]] std::vector<std::filesystem::path> found_in(const std::filesystem::path& folder);

// True if any name in the folder states a side, or if it contains only folders: then its images are not side
// by side.
[[nodiscard]] bool has_sides(const std::filesystem::path& folder);

// Empty if no name states a side. Throws Error in one line: an image without its partner, two with one name,
// more than two cameras.
[[nodiscard]] FoundPairs find_pairs(const std::filesystem::path& folder);

// "only the folders a (12 images) and b (9 images)"; empty for an empty folder.
[[nodiscard]] std::string contents_of(const std::filesystem::path& folder);

}  // namespace enc::images
