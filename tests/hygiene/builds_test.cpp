// Other builds: examples/ with an installed core and in the tree, and the program without vision.
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/hygiene/tally.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::tests {
namespace {

namespace fs = std::filesystem;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

// ---- The interface for other people's code: somebody else builds examples/ with an installed core, and in
// the tree with the twin.

std::string build_dir() { return fs::path(program_file()).parent_path().string(); }

// The elementary functions of core/math come with the core, so a step has equal bits outside.
TEST(Door, ExamplesBuildOverAnInstalledCoreAndTheProgramLoadsTheirDriver) {
  if (!test::kCanTally) GTEST_SKIP() << "what is installed has no sanitizers";
  const test::TemporaryFolder folder;
  const std::string prefix = folder.file("prefix"), made = folder.file("made");
  const Result installed =
      run({"cmake", "--install", build_dir(), "--prefix", prefix, "--component", "core"}, {}, 120.0);
  ASSERT_EQ(installed.code, 0) << installed.err;
  EXPECT_FALSE(fs::exists(prefix + "/bin")) << "the core alone";
  // Moved: nothing in the folder depends on its first place.
  const std::string moved = folder.file("moved");
  fs::rename(prefix, moved);
  const Result configured =
      run({"cmake", "-S", source_dir() + "/examples", "-B", made, "-DCMAKE_BUILD_TYPE=Release",
           "-DCMAKE_PREFIX_PATH=" + moved, "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror"},
          {}, 120.0);
  ASSERT_EQ(configured.code, 0) << configured.err;
  const Result compiled = run({"cmake", "--build", made}, {}, 300.0);
  ASSERT_EQ(compiled.code, 0) << compiled.out << compiled.err;

  const Result stepped = run({made + "/step"});
  EXPECT_EQ(stepped.code, 0);
  EXPECT_THAT(stepped.out, HasSubstr("2500 ms  follow"));
  // 700 N/m of hand and 2000 N/m of wall in series, moved 8 mm: 4.15 N and 2.07 mm.
  EXPECT_THAT(stepped.out, ContainsRegex("4500 ms  contact .*deflection 2\\.0[0-9] mm  force 4\\.1[0-9] N"));
  const Result checked =
      run_program({"check", shipped_scene("tennis_ball"), "--set", "rig.force.driver=steady"},
                  {{"ENCOUNTER_MODULES", made}});
  EXPECT_THAT(checked.out, HasSubstr("steady at 192.168.1.1")) << checked.err;
}

// Every `#include "..."` of an installed header is installed, too.
void expect_complete(const std::string& headers) {
  static const std::regex kOurs(R"re(^#include "([^"]+)")re");
  std::size_t seen = 0;
  for (const auto& entry : fs::recursive_directory_iterator(headers)) {
    if (entry.path().extension() != ".h" || entry.path().string().starts_with(headers + "/mujoco/")) continue;
    std::ifstream in(entry.path());
    std::smatch match;
    for (std::string line; std::getline(in, line); seen += match.empty() ? 0 : 1)
      if (std::regex_search(line, match, kOurs)) {
        EXPECT_TRUE(fs::exists(headers + "/" + match[1].str())) << entry.path() << ": " << line;
      }
  }
  EXPECT_GT(seen, 300U);
}

// Builds examples/benchmark.cpp over an installed kit, in the folder "made".
void build_touch(const test::TemporaryFolder& folder) {
  const std::string prefix = folder.file("prefix"), moved = folder.file("moved"), made = folder.file("made");
  for (const char* part : {"core", "benchmark"}) {
    const Result installed =
        run({"cmake", "--install", build_dir(), "--prefix", prefix, "--component", part}, {}, 120.0);
    ASSERT_EQ(installed.code, 0) << installed.err;
  }
  fs::rename(prefix, moved);
  expect_complete(moved + "/include/encounter");
  const Result configured =
      run({"cmake", "-S", source_dir() + "/examples", "-B", made, "-DCMAKE_BUILD_TYPE=Release",
           "-DCMAKE_PREFIX_PATH=" + moved, "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror -O0"},
          {}, 120.0);
  ASSERT_EQ(configured.code, 0) << configured.err;
  const Result compiled = run({"cmake", "--build", made, "--target", "encounter_bench_touch"}, {}, 300.0);
  ASSERT_EQ(compiled.code, 0) << compiled.out << compiled.err;
}

// "0.5244" of the line "touch.miss.20.median    0.5244 mm".
std::string printed_value(const std::string& text, const std::string& id) {
  std::smatch match;
  return std::regex_search(text, match, std::regex(id + " +([0-9.]+) mm")) ? match[1].str()
                                                                           : id + " is not there";
}

// The program lists, runs and reports a benchmark of somebody else as its own.
TEST(Door, ABenchmarkBuildsOverAnInstalledKitAndTheProgramRunsIt) {
  if (!test::kCanTally) GTEST_SKIP() << "what is installed has no sanitizers";
  if (!is_built("bench")) GTEST_SKIP() << "no benchmarks in this build";
  const test::TemporaryFolder folder;
  build_touch(folder);
  if (HasFatalFailure()) return;
  const std::string made = folder.file("made"), out = folder.file("out");
  std::ofstream(made + "/encounter_bench_broken.so") << "no library";
  const auto bench = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "bench");
    return run_program(words, {{"ENCOUNTER_MODULES", made}, kShipped.front()});
  };

  const Result listed = bench({"--list"});
  EXPECT_EQ(listed.code, 0);
  EXPECT_THAT(listed.out, HasSubstr("\ntouch        tip to tool at first touch, over approach speed\n"));
  EXPECT_THAT(listed.out, HasSubstr("encounter    distance"));
  EXPECT_THAT(listed.err, ContainsRegex("left out: .*encounter_bench_broken\\.so: cannot be loaded"));
  EXPECT_EQ(bench({"broken"}).code, 3);

  const Result ran = bench({"touch", "--quick", "--out", out});
  EXPECT_EQ(ran.code, 0) << ran.out;
  EXPECT_EQ(ran.err.find("broken"), std::string::npos) << "it is not asked for";
  EXPECT_THAT(test::bytes_of(out + "/results.json"), HasSubstr("\"touch.miss.100.median\""));
  // The kit outside gives the figures of the kit inside: `bench encounter` has an equal first touch.
  EXPECT_EQ(printed_value(ran.out, "touch.miss.20.median"),
            printed_value(bench({"encounter.miss.20", "--quick"}).out, "encounter.miss.20.median"));
  // The user's settings reach it, and a figure out of bounds has its exit code.
  const Result deep = bench({"touch", "--quick", "--set", "follow.inset_mm=3"});
  EXPECT_EQ(deep.code, 1) << deep.out;
  EXPECT_THAT(deep.out, HasSubstr("out of bounds: touch.miss.20.median, touch.miss.100.median"));
}

TEST(Door, TheCoreConfiguresWithEigenAlone) {
  const test::TemporaryFolder folder;
  std::vector<std::string> command{
      "cmake", "-S", source_dir(), "-B", folder.file("core"), "-DENCOUNTER_CORE_ONLY=ON"};
  for (const char* other : {"fmt", "tomlplusplus", "CLI11", "nlohmann_json", "pugixml", "TinyGLTF", "MuJoCo",
                            "PNG", "glfw3", "GTest", "OpenCVParts"})
    command.push_back(std::string("-DCMAKE_DISABLE_FIND_PACKAGE_") + other + "=ON");
  const Result configured = run(command, {}, 120.0);
  EXPECT_EQ(configured.code, 0) << configured.err;
}

TEST(Door, TwinAndReplayRunInTheTree) {
  const test::TemporaryFolder folder;
  const Result pressed = run({build_dir() + "/example_twin", shipped_scene("tennis_ball")}, kShipped);
  EXPECT_EQ(pressed.code, 0) << pressed.err;
  EXPECT_THAT(pressed.out, ContainsRegex("\n[0-9.]+,5\\.[0-9]+,1[01]\\.[0-9]+\n"))
      << "11 N before the limit of 6 mm";
  const std::string record = folder.file("r.encrec");
  const Result ran = run_program({"run", shipped_scene("plane"), "--for-s", "3", "--record", record});
  ASSERT_NE(ran.out.find("state hash  "), std::string::npos) << ran.err;
  const Result replayed = run({build_dir() + "/example_replay", record}, kShipped);
  EXPECT_EQ(replayed.code, 0) << replayed.out;
  EXPECT_THAT(replayed.out, HasSubstr("state hash " + ran.out.substr(ran.out.find("state hash  ") + 12, 16)));
}

// ---- The program built without vision (preset lean) runs everything that needs no vision, and reports the
// rest as missing.

TEST(LeftOut, WithoutVisionTheProgramRunsWhatNeedsNoneAndRefusesTheRestInALine) {
  if (is_built("vision")) GTEST_SKIP() << "vision is built here";
  const Result ball = run_program({"run", shipped_scene("tennis_ball")}, kShipped);
  EXPECT_EQ(ball.code, 0) << ball.err;
  EXPECT_THAT(ball.out, HasSubstr("state hash"));
  const Result seen =
      run_program({"run", shipped_scene("plane"), "--set", "rig.tracker.driver=vision"}, kShipped);
  EXPECT_EQ(seen.code, 2);
  EXPECT_THAT(seen.err,
              HasSubstr("--set rig.tracker.driver=vision: there is no driver 'vision'; expected one of"));
  EXPECT_THAT(seen.err, HasSubstr("build it"));
  const Result images = run_program({"calibrate", "camera", "vishap", "--through-images"}, kShipped);
  EXPECT_EQ(images.code, 2);
  EXPECT_THAT(images.err, HasSubstr("there is no module 'vision'; build it"));
}

}  // namespace
}  // namespace enc::tests
