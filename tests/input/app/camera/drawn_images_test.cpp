// Images that the twin draws: `encounter calibrate camera RIG --through-images`, and equal bits with any
// number of threads.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"
#include "tests/support/twin.h"

namespace enc::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// ---- `encounter calibrate camera RIG --through-images` as a person uses it, and its refusals.

std::vector<std::string> words(const std::vector<std::string>& more) {
  std::vector<std::string> all{"calibrate", "camera", "vishap", "--through-images"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

// The single line on stderr, with exit code 2.
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

// The program looks for its own modules beside itself: here it has only the module of fits.
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

// ---- The number of threads that draw the twin's images does not matter: the bits are equal.

const std::string kFolder = tests::source_dir() + "/models";

// A finger that approaches, is visible from 0.9 s on, and touches at 1.4 s; images with a quarter of the
// pixels.
const std::vector<std::string> kPress{"run",
                                      kFolder + "/scenes/camera/wall.toml",
                                      "--json",
                                      "--for-s",
                                      "2",
                                      "--set",
                                      "user.approach_mm_s=[200]",
                                      "user.approach_from_mm=125"};

struct ReportedImages {
  nlohmann::json report;
  std::map<std::string, std::string> images;  // by name
};

// Mesa reads the number once, when OpenGL starts; so each number needs a process. Only the driver llvmpipe
// has threads.
ReportedImages drawn_by(const std::string& threads) {
  const test::TemporaryFolder folder;
  const std::filesystem::path frames = folder.path() / "frames";
  std::vector<std::string> words = kPress;
  const std::vector<std::string> small = test::quarter_size();
  words.insert(words.end(), small.begin(), small.end());
  words.insert(words.begin() + 2, {"--frames", frames});
  const Result r = run_program(words, {{"LP_NUM_THREADS", threads},
                                       {"LIBGL_ALWAYS_SOFTWARE", "1"},
                                       {"GALLIUM_DRIVER", "llvmpipe"},
                                       {"ENCOUNTER_MODELS", kFolder}});
  EXPECT_EQ(r.code, 0) << r.err << r.out;
  ReportedImages drawn;
  if (r.code != 0) return drawn;
  drawn.report = nlohmann::json::parse(r.out);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(frames))
    if (entry.path().extension() == ".png")
      drawn.images[std::filesystem::relative(entry.path(), frames)] = test::bytes_of(entry.path());
  return drawn;
}

TEST(DrawingThreads, OneOrTwoGiveTheSameBits) {
  const ReportedImages one = drawn_by("1"), two = drawn_by("2");
  ASSERT_FALSE(one.report.empty() || two.report.empty());
  EXPECT_GT(two.report["threads"], one.report["threads"]) << "the number has not come to the renderer";
  for (const ReportedImages* drawn : {&one, &two}) {
    EXPECT_EQ(drawn->images.size(), 82U) << "at 20 Hz, two of them, from 0 to 2 s";
    EXPECT_EQ(drawn->report["vision"]["rate_hz"], 20.0);
    EXPECT_GT(drawn->report["modes_s"]["follow"], 0.3) << "the finger was seen";
    EXPECT_GE(drawn->report["contacts"], 1);
  }
  EXPECT_EQ(one.report["state_hash"], two.report["state_hash"]);
  for (const auto& [name, bytes] : one.images)
    EXPECT_TRUE(two.images.contains(name) && bytes == two.images.at(name)) << name;
}

}  // namespace
}  // namespace enc::tests
