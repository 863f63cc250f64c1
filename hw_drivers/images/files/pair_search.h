// Which image of a folder belongs to which: by what their names, or those of two folders in it, say of the
// side.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace enc::images {

struct PairFiles {
  std::string left, right;  // of side_by_side both are the same file
};
struct FoundPairs {
  std::vector<PairFiles> pairs;  // in natural order
  std::size_t others = 0;        // images beside them, whose names say no side
};

// Images of a folder, not of the folders in it. Throws Error where it cannot be read.
[[nodiscard]] std::vector<std::filesystem::path> found_in(const std::filesystem::path& folder);

// Whether anything in the folder says a side, or there are folders alone: then its images are not side by
// side.
[[nodiscard]] bool has_sides(const std::filesystem::path& folder);

// Empty where nothing says a side. Throws Error in one line: an image without its partner, two of one name,
// more than two cameras.
[[nodiscard]] FoundPairs find_pairs(const std::filesystem::path& folder);

// "only the folders a (12 images) and b (9 images)"; empty where there is nothing.
[[nodiscard]] std::string contents_of(const std::filesystem::path& folder);

}  // namespace enc::images
