// The script `encounter` in a clone that was never built, and the commit that a build records.
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gmock/gmock.h>

#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::tests {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr, testing::MatchesRegex;

// The part of a clone that the script reads.
class FirstCall : public testing::Test {
 protected:
  FirstCall() {
    for (const char* name :
         {"encounter", "CMakeLists.txt", "cmake/commit.sh", "cmake/setup.sh", "app/command_line/help.txt"}) {
      fs::create_directories((at() / name).parent_path());
      fs::copy_file(fs::path(source_dir()) / name, at() / name);
    }
  }
  [[nodiscard]] fs::path at() const { return fs::path(folder_.path()) / "clone"; }
  [[nodiscard]] Result call(const std::string& word) const {
    return run({"bash", (at() / "encounter").string(), word});
  }
  [[nodiscard]] std::string commit() const {
    const Result r = run({"bash", (at() / "cmake/commit.sh").string()});
    EXPECT_EQ(r.code, 0) << r.err;
    return r.out;
  }
  // Return false if git is missing.
  [[nodiscard]] bool git(const std::string& words, const fs::path& in) const {
    const Result r = run({"bash", "-c",
                          "cd '" + in.string() +
                              "' && unset GIT_DIR && export HOME=. GIT_CONFIG_NOSYSTEM=1 && "
                              "git -c user.name=x -c user.email=x@y.z " +
                              words});
    return r.code == 0;
  }
  test::TemporaryFolder folder_;
};

TEST_F(FirstCall, VersionAndHelpAnswerWithoutABuild) {
  const Result version = call("--version"), help = call("--help");
  EXPECT_EQ(version.code, 0) << version.err;
  EXPECT_THAT(version.out, MatchesRegex("Encounter [0-9]+\\.[0-9]+\\.[0-9]+, commit unknown of unknown\n"));
  EXPECT_EQ(help.code, 0) << help.err;
  EXPECT_THAT(help.out, HasSubstr("  run "));
  EXPECT_FALSE(fs::exists(at() / "build"));
}

// Only a subject that reads images of a calibration needs OpenCV, and only pictures of a camera need vision.
TEST_F(FirstCall, EachSubjectOfCalibrateInstallsWhatItNeeds) {
  std::ofstream(at() / "cmake/setup.sh") << "setup_begin() { echo \"${packages[*]}\"; exit 0; }\n";
  const auto packages = [&](const std::string& words) {
    return run({"bash", "-c", "cd '" + at().string() + "' && ./encounter calibrate " + words}).out;
  };
  for (const char* words : {"tracker l.csv", "tip l.csv", "camera vishap", "rig sim", "sim", "app", ""})
    EXPECT_EQ(packages(words), "\n") << words;
  for (const char* words : {"stereo app", "skin app --masks app"})
    EXPECT_EQ(packages(words), "opencv\n") << words;
  EXPECT_EQ(packages("camera vishap --through-images"), "vision\n");
}

// The script prints a file; the program must print the same text.
TEST_F(FirstCall, TheHelpOfTheScriptIsThatOfTheProgram) {
  EXPECT_EQ(run_program({"--help"}).out, call("--help").out)
      << "build/release/encounter --help >app/command_line/help.txt makes it anew";
}

// Each subcommand: a sentence, an example, and no line beyond a terminal's 80 columns.
TEST(Help, FitsATerminalAndShowsAnExample) {
  std::istringstream all(run_program({"--help"}).out);
  std::size_t commands = 0;
  bool listed = false;
  for (std::string line; std::getline(all, line);) {
    EXPECT_LE(line.size(), 80U) << line;
    listed = listed || line == "Subcommands:";
    if (!listed || line.size() < 3 || !line.starts_with("  ") || line[2] == ' ') continue;
    const std::string name = line.substr(2, line.find(' ', 2) - 2);
    const std::string help = run_program({name, "--help"}).out;
    EXPECT_TRUE(help.size() > 1 && help[0] >= 'A' && help[0] <= 'Z') << help.substr(0, 80);
    EXPECT_THAT(help, HasSubstr("Example: encounter " + name));
    EXPECT_NE(help.find_first_not_of(' ', help.find('\n') + 1), std::string::npos);
    EXPECT_NE(help[help.find('\n') + 1], ' ') << name << ": the sentence goes on at column 0";
    std::istringstream lines(help);
    for (std::string one; std::getline(lines, one);) EXPECT_LE(one.size(), 80U) << name << ": " << one;
    ++commands;
  }
  EXPECT_GT(commands, 15U);
}

TEST_F(FirstCall, TheCommitIsThatOfTheRepositoryAndSaysWhereCodeWasChanged) {
  EXPECT_EQ(commit(), "unknown unknown\n") << "a tarball";
  if (!git("init -q . && git add -A && git -c user.name=x -c user.email=x@y.z commit -q -m x", at()))
    GTEST_SKIP() << "there is no git";
  const std::string clean = commit();
  EXPECT_THAT(clean, MatchesRegex("[0-9a-f]{12} [0-9]{4}-[0-9]{2}-[0-9]{2}\n"));
  std::ofstream(at() / "README.md") << "words are no code\n";
  EXPECT_EQ(commit(), clean);
  fs::create_directories(at() / "core");
  std::ofstream(at() / "core/new.cpp") << "\n";
  EXPECT_EQ(commit(), clean.substr(0, 12) + "-dirty" + clean.substr(12));
}

// An unpacked tarball inside somebody's repository must not take that repository's commit.
TEST_F(FirstCall, ARepositoryAroundItIsAnotherOne) {
  if (!git("init -q . && git -c user.name=x -c user.email=x@y.z commit -q --allow-empty -m x",
           folder_.path()))
    GTEST_SKIP() << "there is no git";
  EXPECT_EQ(commit(), "unknown unknown\n");
}

// A second build of an unchanged commit compiles nothing.
TEST_F(FirstCall, TheFileOfTheCommitIsWrittenOnlyWhereItChanges) {
  const fs::path file = at() / "commit.cpp";
  const auto write = [&] { return run({"bash", (at() / "cmake/commit.sh").string(), file.string()}).code; };
  ASSERT_EQ(write(), 0);
  EXPECT_THAT(test::bytes_of(file), HasSubstr("{\"unknown\", \"unknown\"}"));
  const fs::file_time_type old = fs::last_write_time(file) - std::chrono::hours(1);
  fs::last_write_time(file, old);
  ASSERT_EQ(write(), 0);
  EXPECT_EQ(fs::last_write_time(file), old);
  std::ofstream(file) << "another\n";
  ASSERT_EQ(write(), 0);
  EXPECT_THAT(test::bytes_of(file), HasSubstr("unknown"));
}

// The program reports the commit of its sources.
TEST_F(FirstCall, TheProgramSaysItsCommit) {
  EXPECT_THAT(
      run_program({"--version"}).out,
      MatchesRegex("Encounter [0-9.]+, commit ([0-9a-f]{12}(-dirty)? of [0-9-]{10}|unknown of unknown)\n"));
}

}  // namespace
}  // namespace enc::tests
