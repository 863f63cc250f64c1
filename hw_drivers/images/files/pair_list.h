// A folder of stereo images: the pairs of files, in natural order (frame 9 before frame 10).
//
//   pairs          left01.png right01.png ..., or left/01.png right/01.png ...: equal but for the side
//   side_by_side   01.png ...: the left image in the left half
#pragma once

#include <string>
#include <vector>

#include "core/base/words.h"
#include "hw_drivers/images/files/image_file.h"

namespace enc::images {

enum class Layout : std::uint8_t { pairs, side_by_side };
constexpr auto words(Layout) { return enum_words("pairs", "side_by_side"); }

struct PairFiles {
  std::string left, right;  // side_by_side: both are one file
};
struct PairList {
  Layout layout = Layout::pairs;
  ImageSize size;  // each of the two images
  std::vector<PairFiles> pairs;
  // Description of the pairing: "left01.png with right01.png, and 12 pairs more".
  std::string words;
};

// Paths of all images of a folder, in natural order. Throws Error if it cannot be read.
[[nodiscard]] std::vector<std::string> images_in(const std::string& folder);

// side_by_side if no name of a file or folder states a side.
[[nodiscard]] Layout layout_of(const std::string& folder);

// Reads all headers. Throws Error in one line that names the file: no folder, no images in it, an image
// without its partner, of another size, or of another format.
[[nodiscard]] PairList list_pairs(const std::string& folder, Layout layout);

// The pixels of a pair; the memory is reused. Throws Error: damaged, or no longer of the list's size.
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

// Splits an image of both sides into its halves.
void split(const ImageView& both, ImagePair& into);

}  // namespace enc::images
