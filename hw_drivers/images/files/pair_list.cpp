#include "hw_drivers/images/files/pair_list.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include <fmt/format.h>

#include "core/error.h"

namespace enc::images {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Numbers by their value, the rest by its letters.
struct NaturalOrder {
  bool operator()(const std::string& a, const std::string& b) const {
    std::size_t i = 0, j = 0;
    while (i < a.size() && j < b.size()) {
      if (is_digit(a[i]) && is_digit(b[j])) {
        const std::string_view x = number(a, i), y = number(b, j);
        if (x.size() != y.size()) return x.size() < y.size();
        if (x != y) return x < y;
      } else if (a[i] != b[j]) {
        return a[i] < b[j];
      } else {
        ++i, ++j;
      }
    }
    return a.size() - i != b.size() - j ? a.size() - i < b.size() - j : a < b;
  }
  // Without leading zeros; leaves `at` behind it.
  static std::string_view number(const std::string& text, std::size_t& at) {
    while (at + 1 < text.size() && text[at] == '0' && is_digit(text[at + 1])) ++at;
    const std::size_t begin = at;
    while (at < text.size() && is_digit(text[at])) ++at;
    return std::string_view(text).substr(begin, at - begin);
  }
};
using Names = std::map<std::string, std::string, NaturalOrder>;  // what two partners share: path

std::vector<fs::path> found_in(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed))
    if (is_image_name(entry->path().filename().string()) && !entry->is_directory(failed))
      found.push_back(entry->path());
  if (failed)
    throw Error(
        fmt::format("{}: cannot read this folder: {}; expected a folder of PNG or JPEG images; see to "
                    "its name",
                    folder.string(), failed.message()));
  return found;
}

// "img_left07" without "left" is "img_07"; whether the word was there.
bool take_word(std::string& stem, const std::string& word) {
  std::string lower(stem);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  const std::size_t at = lower.find(word);
  if (at == std::string::npos) return false;
  stem.erase(at, word.size());
  return true;
}

// In a subfolder of a side every image is of that side, with the word in its name or without.
Names names_of(const fs::path& folder, const std::string& word, bool always) {
  Names names;
  for (const fs::path& file : found_in(folder)) {
    std::string stem = file.stem().string();
    if (!take_word(stem, word) && !always) continue;
    const auto [other, is_new] = names.emplace(stem, file.string());
    if (!is_new)
      throw Error(fmt::format("{}: {} is the same image by its name; expected one of them; remove the other",
                              file.string(), other->second));
  }
  return names;
}

struct Sides {
  Names left, right;
};
bool has_subfolders(const fs::path& folder) {
  std::error_code none;
  return fs::is_directory(folder / "left", none) && fs::is_directory(folder / "right", none);
}
Sides sides_of(const fs::path& folder) {
  if (has_subfolders(folder))
    return {names_of(folder / "left", "left", true), names_of(folder / "right", "right", true)};
  return {names_of(folder, "left", false), names_of(folder, "right", false)};
}

void refuse_single(const Names& names, const Names& partners, const char* side) {
  for (const auto& [shared, path] : names)
    if (!partners.contains(shared))
      throw Error(
          fmt::format("{}: has no {} image; expected one with the same name but for the word '{}'; add "
                      "it or remove this one",
                      path, side, side));
}

std::vector<PairFiles> pairs_in(const fs::path& folder) {
  const Sides sides = sides_of(folder);
  refuse_single(sides.left, sides.right, "right");
  refuse_single(sides.right, sides.left, "left");
  std::vector<PairFiles> pairs;
  for (const auto& [shared, path] : sides.left) pairs.push_back({path, sides.right.at(shared)});
  return pairs;
}

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

}  // namespace

std::vector<std::string> images_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const fs::path& file : found_in(folder)) names.push_back(file.string());
  std::sort(names.begin(), names.end(), NaturalOrder());
  return names;
}

Layout layout_of(const std::string& folder) {
  if (has_subfolders(folder)) return Layout::pairs;
  const Sides sides = sides_of(folder);
  return sides.left.empty() && sides.right.empty() ? Layout::side_by_side : Layout::pairs;
}

PairList list_pairs(const std::string& folder, Layout layout) {
  PairList list{layout, {}, layout == Layout::pairs ? pairs_in(folder) : halves_in(folder)};
  if (list.pairs.empty())
    throw Error(fmt::format("{}: has no {}; expected {}; see docs/guide/camera.md", folder,
                            layout == Layout::pairs ? "pairs of images" : "images",
                            layout == Layout::pairs
                                ? "left01.png, right01.png, ... or folders left and right"
                                : "PNG or JPEG files, each with the left image in its left half"));
  const std::string& first = list.pairs.front().left;
  const ImageSize wanted = image_size(first);
  for (const PairFiles& pair : list.pairs) {
    refuse_size(pair.left, image_size(pair.left), first, wanted);
    if (layout == Layout::pairs) refuse_size(pair.right, image_size(pair.right), first, wanted);
  }
  list.size = layout == Layout::pairs ? wanted : half_of(wanted, first);
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
