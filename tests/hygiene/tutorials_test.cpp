// Runs docs/tutorial: each block of commands as a reader types it, and compares its output with the page.
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/hygiene/tally.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::tests {
namespace {

namespace fs = std::filesystem;

struct Block {
  std::string language, text;
};
std::vector<Block> blocks_of(const std::string& page) {
  std::ifstream in(source_dir() + "/docs/tutorial/" + page);
  EXPECT_TRUE(in) << page;
  std::vector<Block> blocks;
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    const bool fence = line.starts_with("```");
    if (fence && !inside) blocks.push_back({line.substr(3), ""});
    if (fence) inside = !inside;
    if (!fence && inside) blocks.back().text += line + "\n";
  }
  EXPECT_FALSE(inside) << page << ": a block has no end";
  return blocks;
}

// Turns a line of the page into a regular expression: "…" stands for any text, and the line's ends are open.
std::regex line_of_page(const std::string& line) {
  static const std::regex kSpecial(R"([.^$|()\[\]{}*+?\\])");
  return std::regex(std::regex_replace(std::regex_replace(line, kSpecial, R"(\$&)"), std::regex("…"), ".*"));
}

// The command's output has each line of the page's output, in that order.
void expect_lines(const std::string& printed, const std::string& expected, const std::string& where) {
  std::istringstream page(expected);
  auto from = printed.begin();
  for (std::string line; std::getline(page, line);) {
    std::match_results<std::string::const_iterator> match;
    EXPECT_TRUE(std::regex_search(from, printed.end(), match, line_of_page(line)))
        << where << " shows\n"
        << line << "\nbut the commands print\n"
        << printed;
    if (!match.empty()) from = match[0].second;
  }
}

// Creates a temporary folder that looks like the project's to a reader.
void furnish(const std::string& folder) {
  const fs::path build = fs::path(program_file()).parent_path();
  fs::create_symlink(program_file(), folder + "/encounter");
  fs::create_directories(folder + "/build");
  fs::create_symlink(build, folder + "/build/release");
  for (const char* name : {"models", "examples"})
    fs::create_symlink(source_dir() + "/" + name, folder + "/" + name);
}

// Runs the commands of a page in one shell, with the output of each block in a file. A block of TOML or
// Python is a file whose first line has its name.
void follow(const std::string& page) {
  if (!test::kCanTally) GTEST_SKIP() << "what a reader builds has no sanitizers";
  const test::TemporaryFolder folder;
  furnish(folder.file(""));
  const std::vector<Block> blocks = blocks_of(page);
  std::string script = "set -e -o pipefail; PATH=/usr/bin:$PATH; cd '" + folder.file("") + "'\n";
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto& [language, text] = blocks[i];
    if (language == "toml" || language == "python") {
      std::ofstream(folder.file(text.substr(2, text.find('\n') - 2))) << text;
    } else if (language == "sh") {
      script += "exec > out" + std::to_string(i) + " 2>&1\n" + text;
    }
  }
  const Result ran = run({"bash", "-c", script}, kShipped, 300.0);
  const auto printed = [&](std::size_t i) { return test::bytes_of(folder.file("out" + std::to_string(i))); };
  std::size_t last = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (blocks[i].language == "sh") last = i;
    if (blocks[i].language == "text") expect_lines(printed(last), blocks[i].text, page);
  }
  EXPECT_EQ(ran.code, 0) << page << "\n" << printed(last) << ran.err;
}

TEST(Tutorial, FirstPress) { follow("first_press.md"); }
TEST(Tutorial, FirstScene) { follow("first_scene.md"); }
TEST(Tutorial, FirstRecord) { follow("first_record.md"); }
TEST(Tutorial, FirstDriver) { follow("first_driver.md"); }

}  // namespace
}  // namespace enc::tests
