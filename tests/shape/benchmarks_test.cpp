// The shape of the benchmarks: a plain one is one short file, and their folders have room.
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/built.h"

namespace enc {
namespace {

namespace fs = std::filesystem;
const fs::path kRoot = tests::source_dir();

std::vector<fs::path> sources_in(const std::string& folder) {
  std::vector<fs::path> all;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder))
    if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp") all.push_back(entry.path());
  return all;
}

// What docs/reference/report.md shows as the example.
TEST(BenchmarkShape, APlainBenchmarkIsOneShortFile) {
  const std::vector<fs::path> files = sources_in("benchmarks/encounter");
  ASSERT_EQ(files.size(), 1U);
  std::ifstream in(files.front());
  std::size_t lines = 0;
  for (std::string line; std::getline(in, line);) ++lines;
  EXPECT_GT(lines, 20U);
  EXPECT_LE(lines, 150U) << files.front();
}

// 24 would be too many; a fifth of that is room.
TEST(BenchmarkShape, FoldersHaveRoom) {
  for (const char* where : {"benchmarks", "tests/benchmarks"}) {
    std::map<fs::path, int> files;
    for (const fs::path& source : sources_in(where)) ++files[source.parent_path()];
    EXPECT_GT(files.size(), 3U) << where;
    for (const auto& [folder, count] : files) EXPECT_LE(count, 19) << folder;
  }
}

// The kit, the report and the commands take benchmarks from the table, which these write themselves.
TEST(BenchmarkShape, NoneIsIncludedByWhatServesThemAll) {
  static const std::regex kInclude(R"(^#\s*include "benchmarks[/](\w+).)");
  std::smatch include;
  for (const char* where :
       {"benchmarks/kit", "benchmarks/report", "benchmarks/verdict", "benchmarks/commands"})
    for (const fs::path& source : sources_in(where)) {
      std::ifstream in(source);
      for (std::string line; std::getline(in, line);) {
        if (!std::regex_search(line, include, kInclude)) continue;
        const std::string folder = include[1];
        EXPECT_TRUE(folder == "kit" || folder == "report" || folder == "commands" ||
                    folder == "questionnaire" || folder == "verdict")
            << source << ": " << line;
      }
    }
}

}  // namespace
}  // namespace enc
