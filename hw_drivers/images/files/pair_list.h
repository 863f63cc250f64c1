// A folder of stereo images: which file belongs to which, in natural order (frame 9 before frame 10).
//
//   pairs          left01.png right01.png ..., or left/01.png right/01.png ...: one name but for what says
//   the side side_by_side   01.png ...: the left image in the left half
#pragma once

#include <string>
#include <vector>

#include "core/base/words.h"
#include "hw_drivers/images/files/image_file.h"
#include "hw_drivers/images/files/pair_search.h"

namespace enc::images {

enum class Layout : std::uint8_t { pairs, side_by_side };
constexpr auto words(Layout) { return enum_words("pairs", "side_by_side"); }

struct PairList {
  Layout layout = Layout::pairs;
  ImageSize size;  // of each of the two images
  std::vector<PairFiles> pairs;
  std::string words;  // how the folder was read: "left01.png with right01.png, and 12 pairs more"
};

// Paths of all images of a folder, in natural order. Throws Error where it cannot be read.
[[nodiscard]] std::vector<std::string> images_in(const std::string& folder);

// Side by side, where no name of a file or folder says a side.
[[nodiscard]] Layout layout_of(const std::string& folder);

// Reads all headers. Throws Error in one line that names the file: no folder, no images in it, one without
// its partner, one of another size, one that is no image.
[[nodiscard]] PairList list_pairs(const std::string& folder, Layout layout);

// A pair's pixels; memory is used again. Throws Error: damaged, or no longer of the list's size.
struct ImagePair {
  Image left, right;
};
class PairReader {
 public:
  explicit PairReader(PairList list) : list_(std::move(list)) {}
  [[nodiscard]] const PairList& list() const { return list_; }
  void read(std::size_t index, ImagePair& into);

 private:
  PairList list_;
  Image both_;
};

// The halves of an image of both.
void split(const ImageView& both, ImagePair& into);

}  // namespace enc::images
