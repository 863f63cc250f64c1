// `encounter view`, as a person runs it; and that `encounter run` maps no graphics.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/built.h"
#include "tests/support/bytes_of.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace enc::test {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

const std::string kScene = tests::source_dir() + "/models/scenes/tennis_ball.toml";

// Mesa and LLVM keep some bytes at exit, which the leak checker of the dev build would make ours. All else
// stays checked.
const tests::Environment kNotOurLeaks{{"ASAN_OPTIONS", "detect_leaks=0"}};

unsigned big_endian(const std::string& bytes, std::size_t at) {
  unsigned value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8U | static_cast<unsigned char>(bytes.at(at + i));
  return value;
}

TEST(View, ShotIsAPngOfTheRightSizeWithAPictureInIt) {
  if (!tests::is_built("view")) GTEST_SKIP() << "built without the view";
  const fs::path shot = fs::path(testing::TempDir()) / ("shot_" + std::to_string(getpid()) + ".png");
  const tests::Result result =
      tests::run_program({"view", kScene, "--shot", shot.string(), "--at-s", "0.5"}, kNotOurLeaks);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, HasSubstr("0.500 s"));
  const std::string png = bytes_of(shot);
  fs::remove(shot);
  ASSERT_GT(png.size(), 24U);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(big_endian(png, 16), 1000U);
  EXPECT_EQ(big_endian(png, 20), 700U);
  // A picture of one colour, or of the backdrop alone, packs into less than 10 kB.
  EXPECT_GT(png.size(), 30'000U);
  EXPECT_LT(png.size(), 300'000U);
}

// A pipe whose reader has gone stays. The picture is larger than the 64 KiB that a pipe holds.
TEST(View, ADeviceThatCannotTakeThePictureStays) {
  if (!tests::is_built("view")) GTEST_SKIP() << "built without the view";
  const TemporaryFolder folder;
  const std::string pipe = folder.file("pipe");
  const tests::Result result = tests::run({"bash", "-c",
                                           "trap '' PIPE; mkfifo \"$3\"; head -c 1 \"$3\" > /dev/null & "
                                           "\"$1\" view \"$2\" --at-s 8 --close-up --shot \"$3\"",
                                           "bash", tests::program_file(), tests::shipped_scene("hare"), pipe},
                                          kNotOurLeaks);
  EXPECT_EQ(result.code, 2) << result.out;
  EXPECT_THAT(result.err, HasSubstr("cannot be written"));
  EXPECT_TRUE(fs::is_fifo(pipe));
}

// A ball that is hit is not held: what is shown is the blow, not the finger before it sets out.
TEST(View, ABlowIsShownAtItsTouch) {
  if (!tests::is_built("view")) GTEST_SKIP() << "built without the view";
  const fs::path shot = fs::path(testing::TempDir()) / ("blow_" + std::to_string(getpid()) + ".png");
  const tests::Result result = tests::run_program(
      {"view", tests::source_dir() + "/models/scenes/hit_ball.toml", "--shot", shot.string()}, kNotOurLeaks);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("at 1.5"));
  fs::remove(shot);
}

TEST(View, WhatIsRefusedIsSaidWithItsPlace) {
  if (!tests::is_built("view")) GTEST_SKIP() << "built without the view";
  const std::string far = "object.wall.position_mm=[0, 0, -900]";
  const tests::Result result = tests::run_program(
      {"view", tests::source_dir() + "/models/scenes/wall.toml", "--shot", "a.png", "--set", far},
      kNotOurLeaks);
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err, HasSubstr("--set " + far + ": the arm does not get"));
}

TEST(View, APictureWithoutItsFileSaysSo) {
  const tests::Result result = tests::run_program({"view", kScene, "--close-up"});
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err, HasSubstr("--shot"));
}

TEST(View, AFolderThatIsNotThereIsSaid) {
  if (!tests::is_built("view")) GTEST_SKIP() << "built without the view";
  const tests::Result result =
      tests::run_program({"view", kScene, "--shot", "/nowhere/a.png", "--at-s", "0.1"}, kNotOurLeaks);
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err, HasSubstr("/nowhere/a.png"));
  EXPECT_THAT(result.err, HasSubstr("No such file or directory"));
}

TEST(View, WithoutTheModuleItIsADeviceThatIsMissing) {
  const tests::Result result =
      tests::run_program({"view", kScene, "--shot", "a.png"}, {{"ENCOUNTER_MODULES", "/nowhere"}});
  EXPECT_EQ(result.code, 3);
  EXPECT_THAT(result.err, HasSubstr("/nowhere/encounter_view.so"));
}

// The loader's own account: what `run` maps, at start and later.
TEST(View, RunLoadsNoGraphics) {
  const tests::Result result = tests::run_program({"run", kScene, "--for-s", "0.2"}, {{"LD_DEBUG", "files"}});
  ASSERT_THAT(result.err, HasSubstr("libmujoco"));  // the account is there
  for (const char* heavy : {"opencv", "libGL", "libEGL", "glfw", "libX11", "wayland", "encounter_"})
    EXPECT_THAT(result.err, testing::Not(HasSubstr(heavy)));
}

}  // namespace
}  // namespace enc::test
