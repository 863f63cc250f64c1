// Other builds: examples/ with an installed core and in the tree, and the program without vision.
#include <filesystem>
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
