// The words of comments and pages: turns of phrase that stop a reader, counted per 1,000 words, and comments
// that open with a preposition or a relative. The limits only go down.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/built.h"
#include "tests/support/files.h"

namespace enc::words {
namespace {

namespace fs = std::filesystem;
using Texts = std::vector<std::string>;

// Free relatives and genitives at the beginning of a sentence, negative subjects, devices that speak, and
// similar turns.
const std::regex& turns() {
  static const std::regex kTurns(
      R"((?:^|[.;:!] )(?:What|Where)\b(?![^.?]*\?)|(?:^|[.;:?!] )Of (?!course)|(?:^|[.;:?!] )Who(?:ever)?\b(?![^.?]*\?)|\b[Nn]obody\b|\b(?:is|are|was) none\b|\bnone of (?:it|the|its)\b|\b[Ll]ikewise\b|\bt(?:ells?|old)\b|\bshall\b)");
  return kTurns;
}
const std::regex& opening() {
  static const std::regex kOpening(
      "^(?:of|in|with|from|to|for|at|by|what|where|who|how|when|whether|which)\\b",
      std::regex::ECMAScript | std::regex::icase);
  return kOpening;
}

// The reader, addressed.
const std::regex& reader() {
  static const std::regex kReader(R"(\b[Yy]ou(?:rs?)?\b)");
  return kReader;
}

std::size_t words_in(const std::string& text) {
  std::istringstream in(text);
  return static_cast<std::size_t>(
      std::distance(std::istream_iterator<std::string>(in), std::istream_iterator<std::string>()));
}

// The comments of a source: consecutive lines are one text.
Texts comments_of(const fs::path& file) {
  Texts all;
  std::string now;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const std::size_t start = line.find_first_not_of(" \t");
    if (start != std::string::npos && line.compare(start, 2, "//") == 0) {
      const std::size_t text = line.find_first_not_of("/!< ", start);
      if (text != std::string::npos) now += (now.empty() ? "" : " ") + line.substr(text);
      continue;
    }
    if (!now.empty()) all.push_back(std::move(now));
    now.clear();
    const std::size_t behind = line.find("  // ");
    if (behind != std::string::npos && behind != start) all.push_back(line.substr(behind + 5));
  }
  if (!now.empty()) all.push_back(now);
  return all;
}

// The prose of a page: paragraphs, items and cells, without code, headings and pictures.
Texts prose_of(const fs::path& file) {
  std::ifstream in(file);
  Texts all;
  std::string now;
  bool code = false;
  const auto end = [&] {
    if (words_in(now) > 3) all.push_back(now);
    now.clear();
  };
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("```")) code = !code;
    if (code || line.starts_with("```") || line.starts_with("    ") || line.starts_with("#")) continue;
    if (line.empty() || line.starts_with("- ") || line.starts_with("|") || line.starts_with("1.")) end();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, '|');) {
      const std::size_t text = cell.find_first_not_of(" |*-");
      if (text != std::string::npos) now += (now.empty() ? "" : " ") + cell.substr(text);
      if (line.starts_with("|")) end();
    }
  }
  end();
  return all;
}

struct Count {
  std::size_t words = 0, turns = 0, texts = 0, openings = 0, you = 0;
  std::multimap<std::size_t, std::string, std::greater<>> worst;  // turns and their file
  [[nodiscard]] double turns_per_1000() const {
    return 1e3 * static_cast<double>(turns) / static_cast<double>(std::max<std::size_t>(words, 1));
  }
  [[nodiscard]] double opening_percent() const {
    return 1e2 * static_cast<double>(openings) / static_cast<double>(std::max<std::size_t>(texts, 1));
  }
  [[nodiscard]] std::string worst_files() const {
    std::string text = "\nmost of them in:";
    std::size_t shown = 0;
    for (const auto& [number, file] : worst)
      if (shown++ < 12) text += "\n  " + std::to_string(number) + "  " + file;
    return text;
  }
};

Count count(const std::vector<std::string>& folders, const std::vector<std::string>& ends,
            const std::function<Texts(const fs::path&)>& read) {
  Count all;
  const fs::path top = tests::source_dir();
  for (const std::string& folder : folders)
    for (const auto& entry : fs::recursive_directory_iterator(top / folder)) {
      if (!entry.is_regular_file() ||
          std::find(ends.begin(), ends.end(), entry.path().extension().string()) == ends.end())
        continue;
      std::size_t here = 0;
      for (const std::string& text : read(entry.path())) {
        const std::size_t words = words_in(text);
        all.words += words;
        here += static_cast<std::size_t>(
            std::distance(std::sregex_iterator(text.begin(), text.end(), turns()), std::sregex_iterator()));
        all.you += static_cast<std::size_t>(
            std::distance(std::sregex_iterator(text.begin(), text.end(), reader()), std::sregex_iterator()));
        if (words <= 3) continue;
        ++all.texts;
        if (std::regex_search(text, opening())) ++all.openings;
      }
      all.turns += here;
      all.worst.emplace(here, fs::relative(entry.path(), top).generic_string());
    }
  return all;
}

struct Limit {
  double turns, openings;  // per 1,000 words; percent
};
void expect_within(const Count& count, const Limit& limit) {
  EXPECT_GT(count.words, 500U);
  EXPECT_LE(count.turns_per_1000(), limit.turns) << count.worst_files();
  EXPECT_LE(count.opening_percent(), limit.openings);
}

const std::vector<std::string> kSources{".h", ".cpp"};

TEST(Words, Comments) {
  expect_within(count({"core", "sim", "models", "trial", "hw_drivers", "benchmarks", "app", "examples"},
                      kSources, comments_of),
                {1.0, 3.0});
}
TEST(Words, CommentsOfTests) { expect_within(count({"tests"}, kSources, comments_of), {1.0, 3.0}); }
TEST(Words, Docs) { expect_within(count({"docs"}, {".md"}, prose_of), {1.0, 10.0}); }
// Guides and tutorials speak to their reader.
TEST(Words, GuidesAndTutorials) {
  const Count all = count({"docs/tutorial", "docs/guide"}, {".md"}, prose_of);
  expect_within(all, {1.0, 10.0});
  EXPECT_GE(1e3 * static_cast<double>(all.you), 5.0 * static_cast<double>(all.words));
}

// A reader has three minutes.
TEST(Words, ReadmeIsShort) {
  const std::string text = test::bytes_of(tests::source_dir() + "/README.md");
  EXPECT_LE(words_in(text), 900U);
}

}  // namespace
}  // namespace enc::words
