#include "hw_drivers/images/files/pair_search.h"

#include <algorithm>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/counted.h"
#include "core/base/error.h"
#include "hw_drivers/images/files/image_file.h"
#include "hw_drivers/images/files/pair_names.h"

namespace enc::images {
namespace {

namespace fs = std::filesystem;

const char* word_for(Eye eye) { return eye == Eye::left ? "left" : "right"; }
Eye other(Eye eye) { return eye == Eye::left ? Eye::right : Eye::left; }

std::vector<fs::path> images_in_folder(const fs::path& folder, std::error_code& failed) {
  std::vector<fs::path> found;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed))
    if (is_image_name(entry->path().filename().string()) && !entry->is_directory(failed))
      found.push_back(entry->path());
  return found;
}

// By name, in small letters and without the ending.
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

// --- folders of one eye each ---

struct EyeFolder {
  std::string name;
  fs::path path;  // where its images are: in it, or in the only folder in it that has any
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

// Of a folder that cannot be read: none.
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
    for (const Marked& found : marks_in(left.name, mark, Eye::left, Named::folder))
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

// Names that an image in the folder of its eye may have for its partner: as it is, or without what says the
// side and what joined that to the rest.
std::vector<std::string> shared_names(const fs::path& file, Eye eye) {
  constexpr const char* kJoints = "_-. ";
  const std::string name = file.stem().string();
  std::vector<std::string> names{small_letters(name)};
  for (const Mark mark : kMarks)
    for (const Marked& found : marks_in(name, mark, eye, Named::file)) {
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
  for (const auto& [name, file] : right)  // a whole name stands above one without its side
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

// --- both eyes in one folder ---

bool says(const fs::path& file, Mark mark, Eye eye) {
  return !marks_in(file.stem().string(), mark, eye, Named::file).empty();
}

struct Flat {
  std::vector<std::pair<std::string, PairFiles>> pairs;
  std::map<fs::path, Eye> eyes;  // of those in pairs
};

Flat paired(const Files& files, Mark mark) {
  Flat flat;
  for (const auto& [name, left] : files)
    for (const Marked& found : marks_in(left.stem().string(), mark, Eye::left, Named::file)) {
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

void refuse_singles(const Files& files, const Flat& flat, Mark mark) {
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

// The first that makes pairs; else words, where one is there, and letters, where all images have one.
std::optional<Mark> mark_of(const std::vector<fs::path>& images) {
  Files files;
  for (const fs::path& image : images) files.emplace(small_letters(image.stem().string()), image);
  const auto has_pair = [&](Mark mark) {
    return std::any_of(files.begin(), files.end(), [&](const auto& file) {
      const std::vector<Marked> marks = marks_in(file.second.stem().string(), mark, Eye::left, Named::file);
      return std::any_of(marks.begin(), marks.end(),
                         [&](const Marked& m) { return files.contains(m.partner); });
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

}  // namespace

std::vector<fs::path> found_in(const fs::path& folder) {
  std::error_code failed;
  std::vector<fs::path> found = images_in_folder(folder, failed);
  if (failed)
    throw Error(fmt::format(
        "{}: cannot read this folder: {}; expected a folder of PNG or JPEG images; see to its name",
        folder.string(), failed.message()));
  return found;
}

bool has_sides(const fs::path& folder) {
  const std::vector<fs::path> images = found_in(folder);
  if (mark_of(images) || two_folders(folder)) return true;
  const std::vector<EyeFolder> folders = eye_folders(folder);
  return images.empty() &&
         std::any_of(folders.begin(), folders.end(), [](const EyeFolder& in) { return !in.images.empty(); });
}

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
  Flat flat = paired(files, *mark);
  refuse_singles(files, flat, *mark);
  return {in_order(std::move(flat.pairs)), images.size() - sided.size()};
}

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

}  // namespace enc::images
