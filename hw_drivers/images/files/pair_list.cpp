#include "hw_drivers/images/files/pair_list.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "core/base/counted.h"
#include "core/base/error.h"
#include "hw_drivers/images/files/pair_names.h"

namespace enc::images {
namespace {

namespace fs = std::filesystem;

std::vector<PairFiles> halves_in(const fs::path& folder) {
  std::vector<PairFiles> pairs;
  for (const std::string& name : images_in(folder.string())) pairs.push_back({name, name});
  return pairs;
}

void refuse_size(const std::string& path, const ImageSize& is, const std::string& first,
                 const ImageSize& wanted) {
  if (is != wanted)
    throw Error(
        fmt::format("{}: is {} x {} px; expected {} x {} as {}; take all images with one camera setting",
                    path, is.width, is.height, wanted.width, wanted.height, first));
}

ImageSize half_of(const ImageSize& both, const std::string& path) {
  if (both.width % 2 != 0 || both.width < 2)
    throw Error(
        fmt::format("{}: is {} px wide; expected two images side by side, of an even width; or name the "
                    "files left... and right...",
                    path, both.width));
  return {both.width / 2, both.height};
}

[[noreturn]] void refuse_empty(const std::string& folder, Layout layout) {
  const std::string contents = contents_of(folder);
  throw Error(
      fmt::format("{}: has no {}{}{}; expected left01.png and right01.png, or folders left and right (L and "
                  "R, or cam0 and cam1, "
                  "will do), or images that hold the left one in their left half; see docs/guide/camera.md",
                  folder, layout == Layout::pairs ? "pairs of images" : "images",
                  contents.empty() ? "" : ", only ", contents));
}

// The first pair as an example of all.
std::string words_for(const PairList& list, const std::string& folder, std::size_t others) {
  const auto short_name = [&](const std::string& path) {
    return fs::path(path).lexically_relative(folder).string();
  };
  const PairFiles& first = list.pairs.front();
  std::string words = list.layout == Layout::pairs
                          ? fmt::format("{} with {}", short_name(first.left), short_name(first.right))
                          : fmt::format("the left and the right half of {}", short_name(first.left));
  if (list.pairs.size() > 1) words += fmt::format(", and {} more", list.pairs.size() - 1);
  if (others > 0) words += fmt::format("; {} of no side left aside", counted(others, "image"));
  return words;
}

}  // namespace

std::vector<std::string> images_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const fs::path& file : found_in(folder)) names.push_back(file.string());
  std::sort(names.begin(), names.end(), NaturalOrder());
  return names;
}

Layout layout_of(const std::string& folder) {
  return has_sides(folder) ? Layout::pairs : Layout::side_by_side;
}

PairList list_pairs(const std::string& folder, Layout layout) {
  FoundPairs found = layout == Layout::pairs ? find_pairs(folder) : FoundPairs{halves_in(folder)};
  if (found.pairs.empty()) refuse_empty(folder, layout);
  PairList list{layout, {}, std::move(found.pairs), {}};
  const std::string& first = list.pairs.front().left;
  const ImageSize wanted = image_size(first);
  for (const PairFiles& pair : list.pairs) {
    refuse_size(pair.left, image_size(pair.left), first, wanted);
    if (layout == Layout::pairs) refuse_size(pair.right, image_size(pair.right), first, wanted);
  }
  list.size = layout == Layout::pairs ? wanted : half_of(wanted, first);
  list.words = words_for(list, folder, found.others);
  return list;
}

void split(const ImageView& both, ImagePair& into) {
  const int width = both.width / 2;
  const std::size_t row = 3 * static_cast<std::size_t>(width);
  for (Image* half : {&into.left, &into.right})
    if (half->width != width || half->height != both.height) *half = Image(width, both.height);
  for (int y = 0; y < both.height; ++y) {
    std::copy_n(both.at(0, y), row, into.left.at(0, y));
    std::copy_n(both.at(width, y), row, into.right.at(0, y));
  }
}

void PairReader::read(std::size_t index, ImagePair& into) {
  const PairFiles& files = list_.pairs[index];
  const std::string& first = list_.pairs.front().left;
  if (list_.layout == Layout::side_by_side) {
    read_image(files.left, both_);
    split(both_.view(), into);
    refuse_size(files.left, {into.left.width, into.left.height}, first, list_.size);
    return;
  }
  read_image(files.left, into.left);
  read_image(files.right, into.right);
  refuse_size(files.left, {into.left.width, into.left.height}, first, list_.size);
  refuse_size(files.right, {into.right.width, into.right.height}, first, list_.size);
}

}  // namespace enc::images
