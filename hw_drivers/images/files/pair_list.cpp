#include "hw_drivers/images/files/pair_list.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/base/words.h"
#include "hw_drivers/images/files/image_file.h"

namespace enc::images {
namespace {

namespace fs = std::filesystem;

// ---- the names of images

// Finds the part of a name that states the camera of an image, in any case: left01 and right01, L1 and R1,
// cam0_1 and cam1_1. A name is that of a folder, or of a file without its ending.
enum class Eye : std::uint8_t { left, right };

// Kinds of marks, the plainest first. A letter stands alone or after a small one: L1, 01_l, camL. A number
// follows the word cam or camera, and another number counts the images; in a folder's name, it follows one of
// some more words or stands alone.
enum class Mark : std::uint8_t { word, letter, number };
constexpr std::array kMarks{Mark::word, Mark::letter, Mark::number};
enum class MarkPlace : std::uint8_t { file, folder };

// One part of a name that states this eye. The right camera's number is the left one's plus one.
struct EyeMark {
  std::string rest;     // the name without that part
  std::string partner;  // the other eye's name, in small letters
};

// Compares numbers by value and the rest by letters: frame 9 before frame 10.
struct NaturalOrder {
  bool operator()(const std::string& a, const std::string& b) const;
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_capital(char c) { return c >= 'A' && c <= 'Z'; }
bool is_small(char c) { return c >= 'a' && c <= 'z'; }

// Converts only A to Z.
std::string small_letters(std::string_view text) {
  std::string small(text);
  std::transform(small.begin(), small.end(), small.begin(),
                 [](char c) { return is_capital(c) ? static_cast<char>(c - 'A' + 'a') : c; });
  return small;
}

// A name whose part at `at` states the side; the partner's name has `other` in its place.
EyeMark marked(std::string_view name, std::size_t at, std::size_t length, std::string_view other) {
  EyeMark out{std::string(name), small_letters(name)};
  out.rest.erase(at, length);
  out.partner.replace(at, length, other);
  return out;
}

// True if the letters at `at` end or begin a word that states no side.
bool of_other_word(std::string_view small, std::size_t at) {
  constexpr std::array<std::string_view, 5> kEnd{"bright", "upright", "wright", "copyright", "cleft"};
  const std::string_view word = small.substr(at, small[at] == 'l' ? 4 : 5);
  return small.substr(at).starts_with("leftover") ||
         std::any_of(kEnd.begin(), kEnd.end(), [&](std::string_view other) {
           return other.ends_with(word) && small.substr(0, at + word.size()).ends_with(other);
         });
}

std::vector<EyeMark> words_in(std::string_view name, Eye eye) {
  const std::string_view word = eye == Eye::left ? "left" : "right",
                         other = eye == Eye::left ? "right" : "left";
  const std::string small = small_letters(name);
  std::vector<EyeMark> found;
  for (std::size_t at = small.find(word); at != std::string::npos; at = small.find(word, at + 1))
    if (!of_other_word(small, at)) found.push_back(marked(name, at, word.size(), other));
  return found;
}

std::vector<EyeMark> letters_in(std::string_view name, Eye eye) {
  const char letter = eye == Eye::left ? 'l' : 'r';
  const std::string_view other = eye == Eye::left ? "r" : "l";
  const std::string small = small_letters(name);
  std::vector<EyeMark> found;
  for (std::size_t i = 0; i < small.size(); ++i) {
    if (small[i] != letter || (i + 1 < small.size() && is_small(small[i + 1]))) continue;
    if (i == 0 || !is_small(small[i - 1]) || (is_capital(name[i]) && is_small(name[i - 1])))
      found.push_back(marked(name, i, 1, other));
  }
  return found;
}

// True if the word before a number means a camera. A file needs a second number that counts its images.
bool numbers_cameras(std::string_view before, std::string_view behind, MarkPlace named) {
  constexpr std::array<std::string_view, 2> kCameras{"cam", "camera"};
  constexpr std::array<std::string_view, 14> kFolders{"c",      "eye",    "image", "images", "img",
                                                      "infra",  "ir",     "lens",  "video",  "view",
                                                      "sensor", "stereo", "ch",    "channel"};
  const std::size_t last = before.find_last_not_of("_-. ");
  const std::string_view words = before.substr(0, last == std::string_view::npos ? 0 : last + 1);
  std::size_t begin = words.size();
  while (begin > 0 && is_small(words[begin - 1])) --begin;
  const std::string_view word = words.substr(begin);
  const auto is_one_of = [&](const auto& list) {
    return std::find(list.begin(), list.end(), word) != list.end();
  };
  if (named == MarkPlace::folder)
    return before.empty() ? behind.empty() : is_one_of(kCameras) || is_one_of(kFolders);
  const auto counts = [](std::string_view text) { return std::any_of(text.begin(), text.end(), is_digit); };
  return is_one_of(kCameras) && (counts(before) || counts(behind));
}

std::vector<EyeMark> numbers_in(std::string_view name, Eye eye, MarkPlace named) {
  constexpr std::size_t kLongest = 2;  // digits: longer numbers count images or belong to a maker
  const std::string small = small_letters(name);
  std::vector<EyeMark> found;
  for (std::size_t at = 0, end = 0; at < small.size(); at = end + 1) {
    for (end = at; end < small.size() && is_digit(small[end]);) ++end;
    const std::size_t length = end - at;
    if (length == 0 || length > kLongest) continue;
    const std::string_view all(small);
    if (!numbers_cameras(all.substr(0, at), all.substr(end), named)) continue;
    const int number = std::stoi(small.substr(at, length)) + (eye == Eye::left ? 1 : -1);
    if (number >= 0) found.push_back(marked(name, at, length, fmt::format("{:0{}}", number, length)));
  }
  return found;
}

// The number without leading zeros; moves `at` behind it.
std::string_view number_at(const std::string& text, std::size_t& at) {
  while (at + 1 < text.size() && text[at] == '0' && is_digit(text[at + 1])) ++at;
  const std::size_t begin = at;
  while (at < text.size() && is_digit(text[at])) ++at;
  return std::string_view(text).substr(begin, at - begin);
}

std::vector<EyeMark> marks_in(std::string_view name, Mark mark, Eye eye, MarkPlace named) {
  switch (mark) {
    case Mark::word:
      return words_in(name, eye);
    case Mark::letter:
      return letters_in(name, eye);
    case Mark::number:
      return numbers_in(name, eye, named);
  }
  return {};
}

bool NaturalOrder::operator()(const std::string& a, const std::string& b) const {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string_view x = number_at(a, i), y = number_at(b, j);
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

// ---- the pairs of a folder, by the sides in the names of the images or of two folders in it
struct FoundPairs {
  std::vector<PairFiles> pairs;  // in natural order
  std::size_t others = 0;        // further images whose names state no side
};

const char* word_for(Eye eye) { return eye == Eye::left ? "left" : "right"; }
Eye other(Eye eye) { return eye == Eye::left ? Eye::right : Eye::left; }

std::vector<fs::path> images_in_folder(const fs::path& folder, std::error_code& failed) {
  std::vector<fs::path> found;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed))
    if (is_image_name(entry->path().filename().string()) && !entry->is_directory(failed))
      found.push_back(entry->path());
  return found;
}

// Files by name, in small letters and without the ending.
using Files = std::map<std::string, fs::path, NaturalOrder>;

Files by_name(const std::vector<fs::path>& files) {
  Files names;
  for (const fs::path& file : files) {
    const auto [same, is_new] = names.emplace(small_letters(file.stem().string()), file);
    if (!is_new)
      throw Error(fmt::format("{}: {} is the same image by its name; expected one of them; remove the other",
                              file.string(), same->second.string()));
  }
  return names;
}

[[noreturn]] void refuse_single(const fs::path& file, Eye eye, std::size_t left, std::size_t right) {
  throw Error(
      fmt::format("{}: has no {} image ({} left and {} right images are here); expected one with the same "
                  "name but for the side; "
                  "add it or remove this one",
                  file.string(), word_for(other(eye)), left, right));
}

std::vector<PairFiles> in_order(std::vector<std::pair<std::string, PairFiles>> named) {
  std::stable_sort(named.begin(), named.end(),
                   [](const auto& a, const auto& b) { return NaturalOrder()(a.first, b.first); });
  std::vector<PairFiles> pairs;
  pairs.reserve(named.size());
  for (auto& [name, files] : named) pairs.push_back(std::move(files));
  return pairs;
}

// ---- folders of one eye each

struct EyeFolder {
  std::string name;
  fs::path path;  // the folder that holds its images: itself, or its only subfolder with images
  std::vector<fs::path> images;
};

std::vector<fs::path> folders_in(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed))
    if (entry->is_directory(failed) && !entry->path().filename().string().starts_with('.'))
      folders.push_back(entry->path());
  std::sort(folders.begin(), folders.end(), [](const fs::path& a, const fs::path& b) {
    return NaturalOrder()(a.filename().string(), b.filename().string());
  });
  return folders;
}

// Empty if the folder cannot be read.
std::vector<fs::path> readable_images(const fs::path& folder) {
  std::error_code failed;
  return images_in_folder(folder, failed);
}

EyeFolder eye_folder(const fs::path& path) {
  EyeFolder out{path.filename().string(), path, readable_images(path)};
  if (!out.images.empty()) return out;
  for (const fs::path& inner : folders_in(path)) {
    std::vector<fs::path> images = readable_images(inner);
    if (images.empty()) continue;
    if (!out.images.empty()) return {out.name, path, {}};
    out.path = inner;
    out.images = std::move(images);
  }
  return out;
}

std::vector<EyeFolder> eye_folders(const fs::path& folder) {
  std::vector<EyeFolder> out;
  for (const fs::path& path : folders_in(folder)) out.push_back(eye_folder(path));
  return out;
}

struct FolderPair {
  EyeFolder left, right;
};

std::vector<FolderPair> folder_pairs(const std::vector<EyeFolder>& folders, Mark mark) {
  std::vector<FolderPair> pairs;
  for (const EyeFolder& left : folders)
    for (const EyeMark& found : marks_in(left.name, mark, Eye::left, MarkPlace::folder))
      for (const EyeFolder& right : folders)
        if (small_letters(right.name) == found.partner && !left.images.empty() && !right.images.empty())
          pairs.push_back({left, right});
  return pairs;
}

std::optional<FolderPair> two_folders(const fs::path& folder) {
  const std::vector<EyeFolder> all = eye_folders(folder);
  for (const Mark mark : kMarks) {
    std::vector<FolderPair> pairs = folder_pairs(all, mark);
    if (pairs.empty()) continue;
    const auto plain = std::find_if(pairs.begin(), pairs.end(),
                                    [](const FolderPair& p) { return small_letters(p.left.name) == "left"; });
    if (plain != pairs.end()) return *plain;
    if (pairs.size() == 1) return pairs.front();
    throw Error(fmt::format(
        "{}: has several pairs of folders, such as {} and {}, {} and {}; expected the images of two "
        "cameras; copy those of one pair into folders left and right",
        folder.string(), pairs[0].left.name, pairs[0].right.name, pairs[1].left.name, pairs[1].right.name));
  }
  return {};
}

// Names that may match an image with its partner in the other eye's folder: the whole name, or the name
// without its side and the joint before or after it.
std::vector<std::string> shared_names(const fs::path& file, Eye eye) {
  constexpr const char* kJoints = "_-. ";
  const std::string name = file.stem().string();
  std::vector<std::string> names{small_letters(name)};
  for (const Mark mark : kMarks)
    for (const EyeMark& found : marks_in(name, mark, eye, MarkPlace::file)) {
      const std::string rest = small_letters(found.rest);
      const std::size_t begin = rest.find_first_not_of(kJoints);
      names.push_back(
          begin == std::string::npos ? rest : rest.substr(begin, rest.find_last_not_of(kJoints) - begin + 1));
    }
  return names;
}

std::vector<PairFiles> pairs_of(const FolderPair& folders) {
  const Files left = by_name(folders.left.images), right = by_name(folders.right.images);
  std::map<std::string, fs::path> partners;
  for (const auto& [name, file] : right)  // a whole name takes precedence over one without its side
    partners.emplace(name, file);
  for (const auto& [name, file] : right)
    for (const std::string& shared : shared_names(file, Eye::right)) partners.emplace(shared, file);
  std::vector<std::pair<std::string, PairFiles>> pairs;
  std::map<fs::path, fs::path> taken;
  for (const auto& [name, file] : left) {
    std::optional<fs::path> partner;
    std::string by;
    for (const std::string& shared : shared_names(file, Eye::left))
      if (const auto found = partners.find(shared);
          !partner && found != partners.end() && !taken.contains(found->second))
        partner = found->second, by = shared;
    if (!partner) refuse_single(file, Eye::left, left.size(), right.size());
    taken.emplace(*partner, file);
    pairs.push_back({by, {file.string(), partner->string()}});
  }
  for (const auto& [name, file] : right)
    if (!taken.contains(file)) refuse_single(file, Eye::right, left.size(), right.size());
  return in_order(std::move(pairs));
}

// ---- both eyes in one folder

bool says(const fs::path& file, Mark mark, Eye eye) {
  return !marks_in(file.stem().string(), mark, eye, MarkPlace::file).empty();
}

struct FlatFolder {
  std::vector<std::pair<std::string, PairFiles>> pairs;
  std::map<fs::path, Eye> eyes;  // eyes of the images in pairs
};

FlatFolder paired(const Files& files, Mark mark) {
  FlatFolder flat;
  for (const auto& [name, left] : files)
    for (const EyeMark& found : marks_in(left.stem().string(), mark, Eye::left, MarkPlace::file)) {
      const auto right = files.find(found.partner);
      if (right == files.end()) continue;
      for (const auto& [file, eye] : {std::pair{left, Eye::left}, {right->second, Eye::right}})
        if (!flat.eyes.emplace(file, eye).second)
          throw Error(fmt::format(
              "{}: belongs to more than one image by its name; expected the images of two cameras; copy "
              "those of one pair into folders left and right",
              file.string()));
      flat.pairs.push_back({found.rest, {left.string(), right->second.string()}});
    }
  return flat;
}

void refuse_singles(const Files& files, const FlatFolder& flat, Mark mark) {
  std::map<fs::path, Eye> singles;
  std::size_t left = flat.pairs.size(), right = left;
  for (const auto& [name, file] : files)
    for (const Eye eye : {Eye::left, Eye::right})
      if (!flat.eyes.contains(file) && says(file, mark, eye) && singles.emplace(file, eye).second)
        ++(eye == Eye::left ? left : right);
  for (const Eye eye : {Eye::left, Eye::right})
    for (const auto& [name, file] : files)
      if (const auto found = singles.find(file); found != singles.end() && found->second == eye)
        refuse_single(file, eye, left, right);
}

// The first mark that makes pairs. Otherwise words, if any image has one, or letters, if all images have one.
std::optional<Mark> mark_of(const std::vector<fs::path>& images) {
  Files files;
  for (const fs::path& image : images) files.emplace(small_letters(image.stem().string()), image);
  const auto has_pair = [&](Mark mark) {
    return std::any_of(files.begin(), files.end(), [&](const auto& file) {
      const std::vector<EyeMark> marks =
          marks_in(file.second.stem().string(), mark, Eye::left, MarkPlace::file);
      return std::any_of(marks.begin(), marks.end(),
                         [&](const EyeMark& m) { return files.contains(m.partner); });
    });
  };
  for (const Mark mark : kMarks)
    if (has_pair(mark)) return mark;
  const auto says_any = [](Mark mark) {
    return
        [mark](const fs::path& file) { return says(file, mark, Eye::left) || says(file, mark, Eye::right); };
  };
  if (std::any_of(images.begin(), images.end(), says_any(Mark::word))) return Mark::word;
  if (!images.empty() && std::all_of(images.begin(), images.end(), says_any(Mark::letter)))
    return Mark::letter;
  return {};
}

// Images of a folder, excluding its subfolders. Throws Error if it cannot be read.
std::vector<fs::path> found_in(const fs::path& folder) {
  std::error_code failed;
  std::vector<fs::path> found = images_in_folder(folder, failed);
  if (failed)
    throw Error(fmt::format(
        "{}: cannot read this folder: {}; expected a folder of PNG or JPEG images; see to its name",
        folder.string(), failed.message()));
  return found;
}

// True if any name in the folder states a side, or if it contains only folders. Its images are then not side
// by side.
bool has_sides(const fs::path& folder) {
  const std::vector<fs::path> images = found_in(folder);
  if (mark_of(images) || two_folders(folder)) return true;
  const std::vector<EyeFolder> folders = eye_folders(folder);
  return images.empty() &&
         std::any_of(folders.begin(), folders.end(), [](const EyeFolder& in) { return !in.images.empty(); });
}

// Empty if no name states a side. Throws Error in one line: an image without its partner, two with one name,
// more than two cameras.
FoundPairs find_pairs(const fs::path& folder) {
  const std::vector<fs::path> images = found_in(folder);
  if (const std::optional<FolderPair> folders = two_folders(folder))
    return {pairs_of(*folders), images.size()};
  const std::optional<Mark> mark = mark_of(images);
  if (!mark) return {{}, images.size()};
  std::vector<fs::path> sided;
  for (const fs::path& image : images)
    if (says(image, *mark, Eye::left) || says(image, *mark, Eye::right)) sided.push_back(image);
  const Files files = by_name(sided);
  FlatFolder flat = paired(files, *mark);
  refuse_singles(files, flat, *mark);
  return {in_order(std::move(flat.pairs)), images.size() - sided.size()};
}

// "only the folders a (12 images) and b (9 images)"; empty for an empty folder.
std::string contents_of(const fs::path& folder) {
  constexpr std::size_t kMost = 6;
  std::vector<std::string> words;
  if (const std::size_t images = found_in(folder).size(); images > 0)
    words.push_back(fmt::format("{} whose names say no side", counted(images, "image")));
  std::vector<std::string> folders;
  for (const EyeFolder& in : eye_folders(folder))
    if (folders.size() < kMost)
      folders.push_back(fmt::format("{} ({})", in.name, counted(in.images.size(), "image")));
  if (!folders.empty())
    words.push_back(fmt::format("the folder{} {}", folders.size() == 1 ? "" : "s", fmt::join(folders, ", ")));
  return fmt::format("{}", fmt::join(words, " and "));
}

}  // namespace

// ---- the list of the pairs

namespace {

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

// Describes the first pair as an example.
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
