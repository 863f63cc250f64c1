// `encounter calibrate camera RIG --through-images` as a person uses it, and what it refuses.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/built.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace enc::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::vector<std::string> words(const std::vector<std::string>& more) {
  std::vector<std::string> all{"calibrate", "camera", "vishap", "--through-images"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

// What one line on stderr says, with exit code 2.
std::string line(const std::vector<std::string>& args) {
  const Result r = run_program(args, kShipped);
  EXPECT_EQ(r.code, 2) << r.out;
  EXPECT_EQ(r.out, "");
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  return r.err;
}

TEST(CalibrateThroughImages, FindsTheBallAndSaysHowOften) {
  const Result text = run_program(words({"--frames", "4"}), kShipped);
  ASSERT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, AllOf(HasSubstr("place 1     4 of 4 frames found the ball; a frame scatters by 0."),
                              HasSubstr("place 8     4 of 4"), HasSubstr("[frames.W_C]\n")));
  const Result json = run_program(words({"--frames", "4", "--json"}), kShipped);
  const auto told = nlohmann::json::parse(json.out);
  ASSERT_EQ(told["places"].size(), 8U);
  EXPECT_EQ(told["places"][0]["found"], 4);
  for (std::size_t a = 0; a < 3; ++a) EXPECT_LT(told["true_error_mm"][a].get<double>(), 0.5);
  EXPECT_EQ(run_program(words({"--frames", "4", "--json"}), kShipped).out, json.out);  // to the byte
  EXPECT_NE(run_program(words({"--frames", "4", "--json", "--seed", "2"}), kShipped).out, json.out);
}

TEST(CalibrateThroughImages, SaysWhyTheBallWasNotFound) {
  EXPECT_THAT(line(words({"--frames", "1", "--set", "truth.camera.exposure=4"})),
              AllOf(HasSubstr("vishap.toml:"), HasSubstr("was found at 0 places and 8 are wanted"),
                    HasSubstr("too bright to have a colour")));
  EXPECT_THAT(line(words({"--frames", "1", "--set", "rig.vision.ball_hue_deg=40"})),
              HasSubstr("nothing of its colour"));
  EXPECT_THAT(line(words({"--frames", "1", "--set", "rig.vision.ball_radius_mm=20"})),
              HasSubstr("not of its size"));
}

TEST(CalibrateThroughImages, RefusesWhatItCannotLookThrough) {
  EXPECT_THAT(line(words({"--set", "rig.camera.driver=images"})),
              AllOf(HasSubstr("--set rig.camera.driver=images: "), HasSubstr("is driven by 'images'"),
                    HasSubstr("expected driver \"sim\"")));
  EXPECT_THAT(line(words({"--set", "rig.vision.ball_radius_mm=0"})), HasSubstr("ball_radius_mm"));
  test::TemporaryFolder temporary;
  const std::string log = (temporary.path() / "log.csv").string();
  std::ofstream(log) << "time_s,tip_x_mm\n0,0\n";
  EXPECT_THAT(line({"calibrate", "camera", log, "--through-images"}),
              HasSubstr("--through-images is of a rig"));
}

// The program looks for its own modules beside itself: here it has only that of fits.
TEST(CalibrateThroughImages, AModuleThatWasNotBuiltIsNamed) {
  namespace fs = std::filesystem;
  test::TemporaryFolder temporary;
  const fs::path program = temporary.path() / "encounter", modules = temporary.path() / "modules";
  fs::copy_file(program_file(), program);
  fs::create_directory(modules);
  fs::create_symlink(fs::path(module_folder()) / "encounter_fit.so", modules / "encounter_fit.so");
  std::vector<std::string> command = words({});
  command.insert(command.begin(), program.string());
  const Result r = run(command, kShipped);
  EXPECT_EQ(r.code, 2) << r.out;
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  EXPECT_THAT(r.err, AllOf(HasSubstr("encounter_vision.so"),
                           HasSubstr("'./encounter calibrate camera RIG --through-images' builds it")));
}

}  // namespace
}  // namespace enc::tests
