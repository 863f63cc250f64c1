// `encounter view`, `view --video` and `tour`, as a person runs them; and `encounter run` maps no graphics.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <unistd.h>

#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf, testing::HasSubstr;

const std::string kScene = tests::source_dir() + "/models/scenes/tennis_ball.toml";

// Mesa and LLVM keep some bytes at exit, which the leak checker of the dev build would report as ours. It
// still checks everything else.
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

// A pipe whose reader has gone is kept. The picture is larger than the 64 KiB that a pipe holds.
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

// A ball that is hit is not held: the picture shows the blow and not the finger before it starts.
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

// The loader's own list of the libraries that `run` maps, at start and later.
TEST(View, RunLoadsNoGraphics) {
  const tests::Result result = tests::run_program({"run", kScene, "--for-s", "0.2"}, {{"LD_DEBUG", "files"}});
  ASSERT_THAT(result.err, HasSubstr("libmujoco"));  // the list is there
  for (const char* heavy : {"opencv", "libGL", "libEGL", "glfw", "libX11", "wayland", "encounter_"})
    EXPECT_THAT(result.err, testing::Not(HasSubstr(heavy)));
}

// `encounter view --video` and `encounter tour`, as a person runs them.

using Words = std::vector<std::string>;

class Film : public testing::Test {
 protected:
  void SetUp() override {
    if (!tests::is_built("view")) GTEST_SKIP() << "built without the view";
  }
  // PATH contains only `programs`. Mesa and LLVM keep some bytes at exit.
  [[nodiscard]] tests::Result view(Words words, const std::string& programs = "/nowhere") const {
    words.insert(words.begin(), {"view", ball_});
    return tests::run_program(words, {{"PATH", programs}, {"ASAN_OPTIONS", "detect_leaks=0"}}, 300.0);
  }
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }
  // A folder with a program `ffmpeg` that is this script.
  [[nodiscard]] std::string ffmpeg(const std::string& script) const {
    fs::create_directories(folder_.path() / "bin");
    const fs::path program = folder_.path() / "bin" / "ffmpeg";
    std::ofstream(program) << "#!/bin/bash\nPATH=/usr/bin:/bin\n" << script << "\n";
    fs::permissions(program, fs::perms::owner_all);
    return program.parent_path().string();
  }
  static std::set<std::string> names_in(const std::string& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
    return names;
  }

  const TemporaryFolder folder_;
  const std::string ball_ = tests::source_dir() + "/models/scenes/tennis_ball.toml";
};

unsigned number_at(const std::string& bytes, std::size_t at) {
  unsigned value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8U | static_cast<unsigned char>(bytes.at(at + i));
  return value;
}

const std::set<std::string> kThree{"frame_00000.png", "frame_00001.png", "frame_00002.png"};

TEST_F(Film, WithoutAnEndingIsAFolderOfFrames) {
  const tests::Result r = view({"--video", path("film"), "--at-s", "0.5", "--for-s", "0.1"});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_EQ(r.err, "");
  EXPECT_THAT(r.out, HasSubstr("3 frames, the world from 0.500 to 0.567 s"));
  EXPECT_EQ(names_in(path("film")), kThree);
  EXPECT_FALSE(fs::exists(path("film.part")));
  const std::string frame = bytes_of(path("film") + "/frame_00001.png");
  EXPECT_EQ(number_at(frame, 16), 1280U);
  EXPECT_EQ(number_at(frame, 20), 720U);
  EXPECT_GT(frame.size(), 30'000U) << "more than a backdrop";
}

// The ball is dented in all frames, and each frame restores it before the next. The third frame of one film
// equals the first frame of another film.
TEST_F(Film, AFrameDoesNotDependOnThoseBefore) {
  ASSERT_EQ(view({"--video", path("a"), "--at-s", "12.9", "--for-s", "0.1"}).code, 0);
  ASSERT_EQ(view({"--video", path("b"), "--at-s", "12.967", "--for-s", "0.03"}).code, 0);
  EXPECT_EQ(bytes_of(path("a") + "/frame_00002.png"), bytes_of(path("b") + "/frame_00000.png"));
  EXPECT_NE(bytes_of(path("a") + "/frame_00001.png"), bytes_of(path("a") + "/frame_00002.png"));
}

TEST_F(Film, WhatIsThereStaysWithoutForce) {
  const Words words{"--video", path("film"), "--for-s", "0.1"};
  ASSERT_EQ(view(words).code, 0);
  const std::string before = bytes_of(path("film") + "/frame_00000.png");
  EXPECT_THAT(tests::one_line(view(words)), AllOf(HasSubstr("is there already"), HasSubstr("--force")));
  Words again{"--video", path("film"), "--for-s", "0.05", "--force"};
  ASSERT_EQ(view(again).code, 0);
  EXPECT_EQ(names_in(path("film")), (std::set<std::string>{"frame_00000.png", "frame_00001.png"}));
  EXPECT_EQ(bytes_of(path("film") + "/frame_00000.png"), before);
  // Encounter does not replace a folder with other content, whatever the options.
  std::ofstream(path("film") + "/thesis.tex") << "mine";
  EXPECT_THAT(tests::one_line(view(again)), HasSubstr("thesis.tex"));
  EXPECT_EQ(names_in(path("film")).size(), 3U);
  std::ofstream(path("file")) << "mine";
  EXPECT_THAT(tests::one_line(view({"--video", path("file"), "--for-s", "0.1", "--force"})),
              HasSubstr("is no folder"));
  EXPECT_EQ(bytes_of(path("file")), "mine");
}

TEST_F(Film, WithoutFfmpegAnyNameIsAFolder) {
  const tests::Result r = view({"--video", path("film.mp4"), "--for-s", "0.1"});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.err, AllOf(HasSubstr("ffmpeg is not installed"), HasSubstr("folder of PNGs")));
  EXPECT_EQ(names_in(path("film.mp4")), kThree);
}

// ffmpeg gets every frame through its standard input. Encounter moves its output into place when it is
// complete.
TEST_F(Film, FfmpegGetsTheFramesAndTheFormat) {
  const std::string programs = ffmpeg(
      "file=${@: -1}; file=${file#file:}; [[ $file == *film.mp4.part ]] || exit 3\n"
      "cat > \"$file\"; echo \"$@\" > \"$file.words\"");
  const tests::Result r = view({"--video", path("film.mp4"), "--for-s", "0.1"}, programs);
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_EQ(fs::file_size(path("film.mp4")), 3U * 3 * 1280 * 720);
  EXPECT_FALSE(fs::exists(path("film.mp4.part")));
  EXPECT_THAT(bytes_of(path("film.mp4.part.words")),
              AllOf(HasSubstr("-f rawvideo -pix_fmt rgb24 -s 1280x720 -r 30 -i -"), HasSubstr("-f mp4")));
}

TEST_F(Film, AnFfmpegThatFailsIsOneLine) {
  const std::string programs = ffmpeg("echo 'no encoder' >&2; exit 1");
  EXPECT_THAT(tests::one_line(view({"--video", path("film.webm"), "--for-s", "0.1"}, programs)),
              AllOf(HasSubstr("film.webm"), HasSubstr("ffmpeg failed: no encoder")));
  EXPECT_FALSE(fs::exists(path("film.webm")));
  EXPECT_FALSE(fs::exists(path("film.webm.part")));
}

TEST_F(Film, BadWordsAreOneLine) {
  const auto line = [&](const Words& words) { return tests::one_line(view(words)); };
  const std::string f = path("film");
  EXPECT_THAT(line({"--video", path("film.txt")}), AllOf(HasSubstr("'.txt'"), HasSubstr(".mp4")));
  EXPECT_THAT(line({"--video", ""}), HasSubstr("--video"));
  EXPECT_THAT(line({"--video", f, "--for-s", "0"}), HasSubstr("--for-s"));
  EXPECT_THAT(line({"--video", f, "--for-s", "nan"}), HasSubstr("--for-s"));
  EXPECT_THAT(line({"--video", f, "--at-s", "-1"}), HasSubstr("--at-s"));
  EXPECT_THAT(line({"--video", f, "--at-s", "3000"}),
              AllOf(HasSubstr("the run ends at"), HasSubstr("--at-s")));
  EXPECT_THAT(line({"--for-s", "1"}), HasSubstr("--video"));
  EXPECT_THAT(line({"--video", f, "--shot", path("a.png")}), HasSubstr("--shot"));
  EXPECT_THAT(line({"--video", f, "--through-camera", "raw"}), HasSubstr("--through-camera"));
  EXPECT_THAT(line({"--video", "/nowhere/no/film.mp4", "--for-s", "1"}), HasSubstr("/nowhere/no"));
  EXPECT_TRUE(names_in(folder_.path().string()).empty());
}

// Ctrl-C ends the film, which is complete up to that frame.
TEST_F(Film, ASignalEndsTheFilm) {
  const tests::Result r =
      tests::run({"bash", "-c",
                  "\"$1\" view \"$2\" --video \"$3\" & v=$!\n"
                  "for i in $(seq 600); do [ -e \"$3.part/frame_00002.png\" ] && break; sleep 0.1; done\n"
                  "kill -TERM $v; wait $v",
                  "bash", tests::program_file(), ball_, path("film")},
                 {{"ASAN_OPTIONS", "detect_leaks=0"}}, 300.0);
  EXPECT_EQ(r.code, 143) << r.err;
  EXPECT_THAT(r.out, HasSubstr("where it was stopped"));
  EXPECT_GE(names_in(path("film")).size(), 3U);
  EXPECT_FALSE(fs::exists(path("film.part")));
}

TEST_F(Film, ATourFilmsEachSceneFromBeforeItsFirstTouch) {
  const fs::path models = folder_.path() / "models", scenes = models / "scenes";
  fs::copy(tests::source_dir() + "/models", models, fs::copy_options::recursive);
  for (const auto& entry : fs::directory_iterator(scenes))
    if (entry.path().filename() != "plane.toml" && entry.path().filename() != "camera")
      fs::remove(entry.path());
  for (const auto& entry : fs::directory_iterator(scenes / "camera"))
    if (entry.path().filename() != "wall.toml") fs::remove(entry.path());
  const Words words{"tour", "--for-s", "0.1", "--out", path("films")};
  const tests::Environment here{
      {"ENCOUNTER_MODELS", models.string()}, {"PATH", "/nowhere"}, {"ASAN_OPTIONS", "detect_leaks=0"}};
  const tests::Result r = tests::run_program(words, here, 300.0);
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_EQ(std::count(r.out.begin(), r.out.end(), '\n'), 2) << r.out;
  EXPECT_EQ(names_in(path("films")), (std::set<std::string>{"camera_wall", "plane"}));
  EXPECT_EQ(names_in(path("films/plane")), kThree);
  EXPECT_THAT(r.out, testing::Not(HasSubstr("from 0.00"))) << "the tool is far away then";
  EXPECT_THAT(tests::one_line(tests::run_program(words, here)), HasSubstr("is there already"));
  EXPECT_THAT(tests::one_line(tests::run_program({"tour", "--for-s", "-1"}, here)), HasSubstr("--for-s"));
}

}  // namespace
}  // namespace enc::test
