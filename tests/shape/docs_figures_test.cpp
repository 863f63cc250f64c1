// The numbers in the docs: docs/figures.py writes each table of figures from
// benchmarks/reference/figures.csv, or the table names the commit that measured it. No number of a table
// changes alone.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::tests {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
const fs::path kTop = tests::source_dir();
constexpr const char* kFigures = "benchmarks/reference/figures.csv";

// Result of docs/figures.py for the pages and figures under `root`: exit code 1 if one is wrong.
Result checked(const fs::path& root) {
  return run({"/usr/bin/python3", "-B", (kTop / "docs/figures.py").string(), "--root", root.string()});
}

std::vector<fs::path> pages() {
  std::vector<fs::path> all{"README.md"};
  for (const char* part : {"docs/notes", "docs/reference"})
    for (const auto& entry : fs::directory_iterator(kTop / part))
      if (entry.path().extension() == ".md") all.push_back(fs::relative(entry.path(), kTop));
  return all;
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::vector<std::string> lines;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}
void write(const fs::path& file, const std::vector<std::string>& lines) {
  fs::create_directories(file.parent_path());
  std::ofstream out(file);
  for (const std::string& line : lines) out << line << "\n";
}

// Replaces the last digit of the line's words, not of its marks.
bool change_a_digit(std::string& line) {
  std::size_t mark = line.size();
  for (std::size_t i = line.size(); i-- > 0;) {
    if (line.compare(i, 3, "-->") == 0) mark = line.rfind("<!--", i);
    if (mark < line.size() && i >= mark) continue;
    if (line[i] < '0' || line[i] > '9') continue;
    line[i] = line[i] == '9' ? '8' : static_cast<char>(line[i] + 1);
    return true;
  }
  return false;
}

TEST(DocsFigures, AreThoseOfTheFile) {
  const Result r = checked(kTop);
  EXPECT_EQ(r.code, 0) << r.out << r.err;
}

// Changes one number in each table with a digest at the same time: the check names each table.
TEST(DocsFigures, ANumberThatIsEditedIsFoundInEachTable) {
  static const std::regex kDigest("<!--table [0-9a-f]{6}-->");
  const test::TemporaryFolder folder;
  fs::create_directories(folder.path() / fs::path(kFigures).parent_path());
  fs::copy_file(kTop / kFigures, folder.path() / kFigures);
  std::vector<std::string> expected;
  for (const fs::path& page : pages()) {
    std::vector<std::string> lines = lines_of(kTop / page);
    for (std::size_t i = 2; i < lines.size(); ++i) {
      if (!std::regex_search(lines[i], kDigest)) continue;
      std::size_t row = i - 2;  // the last one; the rule under the heading has no number
      while (row > 0 && lines[row].starts_with("|") && !change_a_digit(lines[row])) --row;
      ASSERT_TRUE(lines[row].starts_with("|")) << page << ":" << i + 1;
      std::size_t first = row;
      while (first > 0 && lines[first - 1].starts_with("|")) --first;
      expected.push_back(page.string() + ":" + std::to_string(first + 1) + ":");
      expected.push_back(page.string() + ":" + std::to_string(row + 1) + ":");
    }
    write(folder.path() / page, lines);
  }
  EXPECT_GT(expected.size(), 100U);
  const Result r = checked(folder.path());
  EXPECT_EQ(r.code, 1);
  for (std::size_t i = 0; i < expected.size(); i += 2)  // the number has a mark, or is in the digest
    EXPECT_TRUE(r.out.find(expected[i]) != std::string::npos ||
                r.out.find(expected[i + 1]) != std::string::npos)
        << expected[i] << " was edited in line " << expected[i + 1];
}

class DocsPage : public ::testing::Test {
 protected:
  Result checked_with(const std::string& row, const std::string& behind, const std::string& figure) const {
    write(folder_.path() / kFigures, {"# Figures.", "id,unit,value,least,most,low,high,commit", figure});
    write(folder_.path() / "README.md", {"| a | b | c | d | e |", "|---|---|---|---|---|", row, "", behind});
    return checked(folder_.path());
  }
  test::TemporaryFolder folder_;
};

constexpr const char* kFigure = "x.p50,N,0.5678,0.4123,0.7,,,1a2b3c4";
constexpr const char* kNoOthers = "<!--table e3b0c4-->";  // no number without a mark

TEST_F(DocsPage, AMarkedNumberHasTheDecimalsAndTheUnitOfThePage) {
  const std::string right =
      "| it | 0.57<!--x.p50--> | −568<!--x.p50 *-1e3--> | 0.4<!--x.p50 least--> | 5.7e-1<!--x.p50--> |";
  const Result good = checked_with(right, kNoOthers, kFigure);
  EXPECT_EQ(good.code, 0) << good.out << good.err;
  EXPECT_EQ(checked_with(right, kNoOthers, "x.p50,N,0.5778,0.4123,0.7,,,1a2b3c4").code, 1) << "of the file";
  EXPECT_EQ(checked_with("| it | 0.58<!--x.p50--> |", kNoOthers, kFigure).out,
            "README.md:3:8: '0.58' is not the figure x.p50; expected 0.57; run docs/figures.py write.\n");
  EXPECT_THAT(checked_with("| it | 0.57<!--x.p51--> |", kNoOthers, kFigure).out,
              HasSubstr("README.md:3:16: 'x.p51' is no figure of"));
}

TEST_F(DocsPage, ATableOfFiguresHasADigestOfItsOtherNumbers) {
  const std::string row = "| it | 0.57 | 1 | 2 | 3 |";
  EXPECT_THAT(checked_with(row, "", kFigure).out,
              HasSubstr("README.md:1:1: the numbers of this table have no digest"));
  const std::string digest = "<!--table e9c1ce-->";
  const Result good = checked_with(row, "*Kept by hand; measured at 1a2b3c4.*" + digest, kFigure);
  EXPECT_EQ(good.code, 0) << good.out << good.err;
  EXPECT_THAT(
      checked_with("| it | 0.57 | 1 | 2 | 4 |", "*Kept by hand; measured at 1a2b3c4.*" + digest, kFigure).out,
      HasSubstr("README.md:1:1: a number of this table is not what commit 1a2b3c4 measured"));
}

// The output in the README is the program's output. Its first line is the scene's title; times depend on the
// machine, and a line with an ellipsis is shortened.
TEST(DocsFigures, TheReadmeShowsWhatTheProgramPrints) {
  const std::vector<std::string> page = lines_of(kTop / "README.md");
  auto line = std::find(page.begin(), page.end(), "## Reading the output");
  line = std::find(line, page.end(), "```");
  ASSERT_NE(line, page.end());
  const std::string title = *++line;
  std::string scene;
  for (const auto& entry : fs::directory_iterator(kTop / "models/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    const std::vector<std::string> lines = lines_of(entry.path());
    if (std::find(lines.begin(), lines.end(), "title = \"" + title + "\"") != lines.end())
      scene = entry.path().string();
  }
  ASSERT_NE(scene, "") << "no scene has the title " << title;
  const Result r = run_program({"run", scene}, kShipped);
  for (; *line != "```"; ++line) {
    const bool shortened = line->find("…") != std::string::npos;
    const bool timed =
        line->starts_with("tick ") || line->starts_with("time ") || line->starts_with("made by ");
    if (shortened || timed) continue;
    EXPECT_THAT("\n" + r.out, HasSubstr("\n" + *line + "\n"));
  }
}

// The benchmarks named on a page exist: `bench NAME` or `bench NAME.figure`.
TEST(DocsFigures, ABenchmarkThatAPageNamesIsThere) {
  static const std::regex kNamed(R"re((?:^\s*\./|`(?:\./)?)(?:encounter )?bench ([a-z][a-z0-9_-]*))re");
  std::set<std::string> there{"paper-2020", "paper-2003"};  // groups
  for (const auto& entry : fs::directory_iterator(kTop / "benchmarks"))
    there.insert(entry.path().filename().string());
  std::size_t named = 0;
  for (const fs::path& page : pages()) {
    const std::vector<std::string> lines = lines_of(kTop / page);
    for (std::size_t i = 0; i < lines.size(); ++i)
      for (std::sregex_iterator match(lines[i].begin(), lines[i].end(), kNamed), end; match != end; ++match) {
        ++named;
        EXPECT_TRUE(there.contains((*match)[1])) << page << ":" << i + 1 << ": " << match->str();
      }
  }
  EXPECT_GT(named, 30U);
}

}  // namespace
}  // namespace enc::tests
