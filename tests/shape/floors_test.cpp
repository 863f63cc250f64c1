// The floors of core, and folders without circles: each folder can be read after those that it includes. Each
// test prints all offenders.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/built.h"

namespace enc::floors {
namespace {

namespace fs = std::filesystem;

// Floors from the bottom up: a floor includes itself and the floors before it.
constexpr std::array<std::string_view, 9> kFloors{"math",    "base",    "shape",  "machine", "spec",
                                                  "devices", "control", "record", "vision"};

struct Arrow {
  std::string from, to;  // files, from the root
};

std::string folder_of(const std::string& file) { return fs::path(file).parent_path().generic_string(); }

// "devices" for "core/devices/rig.h"; for files in core itself the file.
std::string floor_of(const std::string& file) {
  const std::string rest = file.substr(file.find('/') + 1);
  return rest.substr(0, rest.find('/'));
}
std::size_t height_of(const std::string& file) {
  return static_cast<std::size_t>(std::find(kFloors.begin(), kFloors.end(), floor_of(file)) -
                                  kFloors.begin());
}

// Every include of one of our files in another.
std::vector<Arrow> arrows() {
  static const std::regex kOurs(R"re(^\s*#\s*include\s*"([^"]+/[^"]+)")re");
  const fs::path top = tests::source_dir();
  std::vector<Arrow> all;
  for (const char* folder : {"core", "sim", "models", "trial", "hw_drivers", "benchmarks", "app", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(top / folder)) {
      const fs::path& path = entry.path();
      if (path.extension() != ".h" && path.extension() != ".cpp") continue;
      std::ifstream in(path);
      std::smatch match;
      for (std::string line; std::getline(in, line);)
        if (std::regex_search(line, match, kOurs))
          all.push_back({fs::relative(path, top).generic_string(), match[1]});
    }
  }
  return all;
}

// Folders in a circle, or between two circles: the rest after repeatedly removing folders that include no
// other, and folders that no other includes.
std::set<std::string> in_circles(const std::vector<Arrow>& all) {
  std::map<std::string, std::set<std::string>> reads;
  for (const Arrow& arrow : all)
    if (const std::string from = folder_of(arrow.from), to = folder_of(arrow.to); from != to) {
      reads[from].insert(to);
      reads.try_emplace(to);
    }
  const auto is_read = [&](const std::string& folder) {
    return std::any_of(reads.begin(), reads.end(),
                       [&](const auto& other) { return other.second.contains(folder); });
  };
  for (bool less = true; less;) {
    std::vector<std::string> free;
    for (const auto& [folder, others] : reads)
      if (others.empty() || !is_read(folder)) free.push_back(folder);
    less = !free.empty();
    for (const std::string& folder : free) reads.erase(folder);
    for (auto& [folder, others] : reads)
      for (const std::string& gone : free) others.erase(gone);
  }
  std::set<std::string> left;
  for (const auto& [folder, others] : reads) left.insert(folder);
  return left;
}

TEST(Floors, OfCoreIncludeOnlyThoseBelow) {
  std::size_t between = 0;
  for (const Arrow& arrow : arrows()) {
    if (!arrow.from.starts_with("core/")) continue;
    EXPECT_LT(height_of(arrow.from), kFloors.size()) << arrow.from << " stands on no floor";
    if (!arrow.to.starts_with("core/")) continue;
    between += floor_of(arrow.from) != floor_of(arrow.to) ? 1 : 0;
    EXPECT_LE(height_of(arrow.to), height_of(arrow.from)) << arrow.from << " includes " << arrow.to;
  }
  EXPECT_GT(between, 180U);
}

TEST(Floors, RecordAndVisionStandSideBySide) {
  for (const Arrow& arrow : arrows())
    EXPECT_FALSE(arrow.from.starts_with("core/vision/") && arrow.to.starts_with("core/record/"))
        << arrow.from << " includes " << arrow.to;
}

TEST(Floors, NoFoldersIncludeEachOther) {
  const std::vector<Arrow> all = arrows();
  EXPECT_GT(all.size(), 3000U);
  const std::set<std::string> circles = in_circles(all);
  for (const Arrow& arrow : all) {
    const std::string from = folder_of(arrow.from), to = folder_of(arrow.to);
    EXPECT_TRUE(from == to || !circles.contains(from) || !circles.contains(to))
        << "part of a circle: " << arrow.from << " includes " << arrow.to;
  }
}

TEST(Floors, ACircleIsSeen) {
  const std::vector<Arrow> line{{"a/x.h", "b/x.h"}, {"b/x.h", "c/x.h"}, {"b/y.h", "b/x.h"}};
  EXPECT_TRUE(in_circles(line).empty());
  std::vector<Arrow> circle = line;
  circle.push_back({"c/y.cpp", "a/y.h"});
  circle.push_back({"d/x.h", "a/x.h"});
  EXPECT_EQ(in_circles(circle), (std::set<std::string>{"a", "b", "c"}));
}

}  // namespace
}  // namespace enc::floors
