// A scene with a camera as a person runs it: with the twin's camera, with a folder of images, and the
// refusals.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>

#include "sim/picture/picture.h"
#include "tests/input/app/program.h"
#include "tests/support/built.h"
#include "tests/support/files.h"

namespace enc::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string kScene = tests::source_dir() + "/models/scenes/camera/wall.toml";

class Camera : public Program {
 protected:
  [[nodiscard]] static Result run(const Words& more) {
    Words words{"run", kScene};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  }
  // A rig whose camera is a folder of images.
  [[nodiscard]] std::string images_rig(const std::string& folder) const {
    std::string text = test::bytes_of(path("models/rigs/vishap.toml"));
    text = replaced(text,
                    "[camera]                              # for scenes with a [camera]: STH-MDCS "
                    "(sources/tracking 7)\ndriver = \"sim\"",
                    "[driver.images]\npath = \"" + folder + "\"\n[camera]\ndriver = \"images\"");
    write("models/rigs/files.toml", text);
    return path("models/rigs/files.toml");
  }
};

std::string line_of(const std::string& text, const std::string& begins) {
  const std::size_t at = text.find("\n" + begins);
  return at == std::string::npos ? "" : text.substr(at + 1, text.find('\n', at + 1) - at - 1);
}

TEST_F(Camera, TheTwinsFingerIsSeenAndRepeatsToTheBit) {
  const Result once = run({"--for-s", "3"}), again = run({"--for-s", "3"});
  EXPECT_THAT(once.out, AllOf(HasSubstr("tracker (vision)"),
                              HasSubstr("camera (640 x 480 at 20 Hz, simulated)"), HasSubstr("follow"),
                              HasSubstr("\nvision      20.00 frames/s within the loop; from frame to frame "
                                        "p50 50.0, max 50.0 ms; old when told p50 50.0, max 50.0 ms\n")))
      << once.err;
  EXPECT_FALSE(line_of(once.out, "state hash").empty()) << once.out;
  EXPECT_EQ(line_of(once.out, "state hash"), line_of(again.out, "state hash"));
}

TEST_F(Camera, OneThatStallsIsHeldAndNothingIsFeltFromOldData) {
  const Result stalls = run({"--for-s", "4", "--set", "truth.camera.stalls_at_s=2.5"});
  EXPECT_THAT(stalls.out, AllOf(HasSubstr("hold        at 2.6"), HasSubstr("tracker lost or at fault"),
                                HasSubstr("link        tracker lost at 2.6"), HasSubstr("; 0 contacts")));
}

TEST_F(Camera, LeftAndRightExchangedIsSaidAndMovesNothing) {
  const Result start = run({"--for-s", "3", "--set", "truth.camera.swapped_at_s=0"});
  EXPECT_THAT(start.out, AllOf(HasSubstr("61 frames were not used: left and right are exchanged"),
                               HasSubstr("away 3.00 s; 0 contacts")));
  const Result later = run({"--for-s", "3", "--set", "truth.camera.swapped_at_s=2.5"});
  EXPECT_THAT(later.out, AllOf(HasSubstr("11 frames were not used: left and right are exchanged"),
                               HasSubstr("hold        at 2."), HasSubstr("; 0 contacts")));
}

TEST_F(Camera, OneThatComesBackWithoutAStallIsNotInTheWorld) {
  const auto line = [&](const Words& set) {
    Words words{"check", kScene};
    for (const std::string& s : set) words.insert(words.end(), {"--set", s});
    return refused(words);
  };
  EXPECT_THAT(line({"truth.camera.back_at_s=3"}), HasSubstr("expected more than 'stalls_at_s'"));
  EXPECT_THAT(line({"truth.camera.stalls_at_s=3", "truth.camera.back_at_s=3"}),
              HasSubstr("'back_at_s' is 3; expected more than 'stalls_at_s'"));
}

// Refused before anything moves: such a camera would not see the objects of the scene.
TEST_F(Camera, ARegistrationOfAnotherRigIsRefused) {
  const std::string keypad = tests::source_dir() + "/models/scenes/camera/keypad.toml";
  const auto line = [&](const std::string& scene, const std::string& set) {
    return refused({"check", scene, "--set", "rig.frames.W_C." + set});
  };
  const std::string expected =
      "expected the registration of this rig; make it by `encounter calibrate camera`";
  EXPECT_THAT(line(kScene, "position_mm=[236, -426, 757]"),
              AllOf(HasSubstr("would have object 'wall' outside of the left image"), HasSubstr(expected)));
  EXPECT_THAT(line(kScene, "rotation_deg=[-35, 0, 30]"), HasSubstr("object 'wall' behind it"));
  EXPECT_THAT(line(kScene, "position_mm=[936, -1638, 1757]"), HasSubstr("where 250 to 1500 mm are matched"));
  EXPECT_THAT(line(keypad, "rotation_deg=[-35, 0, 30]"), HasSubstr(", and none of the others in view"));
  EXPECT_THAT(refused({"run", kScene, "--set", "rig.frames.W_C.rotation_deg=[-35, 0, 30]"}),
              HasSubstr(expected));
  const std::string place = line_and_column(test::bytes_of(path("models/rigs/vishap.toml")), "[frames.W_C]");
  edit("models/rigs/vishap.toml",
       "rotation_deg = [-125, 0, 30]          # registered by `encounter calibrate camera`\n\n[arm]",
       "rotation_deg = [-35, 0, 30]\n\n[arm]");
  EXPECT_THAT(refused({"check", kScene, "--rig", path("models/rigs/vishap.toml")}),
              HasSubstr("vishap.toml:" + place + ": a camera that stands there"));
}

TEST_F(Camera, AnObjectOutOfViewAmongOthersIsAWarning) {
  const std::string keypad = tests::source_dir() + "/models/scenes/camera/keypad.toml";
  const Environment no_leaks{{"ASAN_OPTIONS", "detect_leaks=0"}};  // leaks in the graphics libraries
  const Result all = run_program({"check", keypad}, no_leaks);
  EXPECT_THAT(all.err, Not(HasSubstr("no finger is seen"))) << all.err;
  const auto warning = [&](const char* height) {
    const std::string set = std::string("rig.frames.W_C.position_mm=[236, -426, ") + height + "]";
    const Result r = run_program({"check", keypad, "--set", set}, no_leaks);
    EXPECT_EQ(r.code, 0);
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    return r.err;
  };
  EXPECT_THAT(warning("620"),
              HasSubstr("has object 'key_10' outside of the left image, where no finger is seen"));
  EXPECT_THAT(warning("640"), HasSubstr("'key_7' outside of the left image, and 2 more out of view, where"));
}

// The rig places its camera 5 mm beside its true place; the contacts of the prop reveal it.
TEST_F(Camera, ACameraThatHasMovedIsSaid) {
  Words words{"run", kScene};
  for (const char* set : {"user.approach_mm_s=[100, 100]", "user.approach_from_mm=125", "user.depth_mm=6",
                          "user.press_s=1", "user.release_s=1", "user.rest_s=0.3"})
    words.insert(words.end(), {"--set", set});
  const Result there = run_program(words);
  EXPECT_THAT(there.out, AllOf(HasSubstr("\nseen        "), Not(HasSubstr("not where it was registered"))));
  words.insert(words.end(), {"--set", "truth.camera.moved_mm=[5, 0, 0]"});
  const Result moved = run_program(words);
  EXPECT_EQ(moved.code, 1);
  EXPECT_THAT(moved.out, AllOf(HasSubstr("LIMIT       the camera is not where it was registered: 2 presses"),
                               HasSubstr("across their normal the presses do not tell"),
                               HasSubstr("encounter calibrate camera")));
}

// A record replays to the same bits with its images, in both ways.
TEST_F(Camera, ARunAndItsFramesGiveTheSameBits) {
  const std::string record = path("a.encrec"), frames = path("kept");
  const Result once = run({"--for-s", "2.5", "--record", record, "--frames", frames, "--set",
                           "truth.camera.stalls_at_s=1.9", "--set", "truth.camera.back_at_s=2"});
  EXPECT_EQ(once.code, 0) << once.err;
  const Words again{"replay", record, "--frames", frames};
  const Result replayed = run_program(again);
  EXPECT_EQ(replayed.code, 0) << replayed.err << replayed.out;
  EXPECT_THAT(replayed.out, AllOf(HasSubstr("2501 ticks run again, equal to the bit"),
                                  HasSubstr("vision told 48 times what it told then, equal to the bit")));

  const std::string one = frames + "/right/2200000000.png", other = frames + "/right/2250000000.png";
  std::filesystem::copy_file(other, one, std::filesystem::copy_options::overwrite_existing);
  const Result changed = run_program(again);
  EXPECT_EQ(changed.code, 1);
  EXPECT_THAT(changed.out, HasSubstr("vision differs from tick 2250 on: its place in C: recorded ["));
  for (const char* side : {"/left", "/right"}) std::filesystem::remove(frames + side + "/2200000000.png");
  EXPECT_THAT(run_program(again).out, HasSubstr("vision differs from tick 2250 on: its exposure: recorded"));

  EXPECT_THAT(refused({"run", kScene, "--for-s", "1", "--frames", frames}),
              HasSubstr("there is a 'left' in it; expected a folder without frames"));
  EXPECT_THAT(refused({"replay", record, "--frames", path("models")}), HasSubstr("has no frames in 'left'"));
  std::ofstream(frames + "/left/late.png") << "";
  EXPECT_THAT(refused(again), HasSubstr("late.png: is named by no time of exposure"));
  EXPECT_THAT(refused({"run", ball(), "--for-s", "1", "--frames", path("none")}),
              HasSubstr("the scene has no [camera]"));
}

// A camera that plays the frames replaces the original camera.
TEST_F(Camera, PlayedFramesGiveTheStateHashOfTheirRun) {
  const std::string frames = path("kept");
  const Result seen = run({"--for-s", "2.5", "--frames", frames});
  const Result played = run_program({"run", kScene, "--rig", images_rig(frames), "--for-s", "2.5"});
  EXPECT_FALSE(line_of(seen.out, "state hash").empty()) << seen.err;
  EXPECT_EQ(line_of(played.out, "state hash"), line_of(seen.out, "state hash")) << played.err;
}

TEST_F(Camera, NeedsATrackerAnArmAndARigThatHasOne) {
  write("models/scenes/seen.toml", test::bytes_of(kScene));
  const auto without = [&](const std::string& table) {
    write("models/scenes/seen.toml", replaced(test::bytes_of(kScene), "\n" + table, "\n#" + table));
    return refused({"check", path("models/scenes/seen.toml")});
  };
  EXPECT_THAT(without("[tracker]"), HasSubstr("expected a [tracker]; add it"));
  EXPECT_THAT(refused({"check", kScene, "--rig", "sim"}),
              HasSubstr("has none; expected a [camera] with a driver"));
  edit("models/scenes/tennis_ball.toml", "[tracker]\n", "[tracker]\n[camera]\n");
  EXPECT_THAT(refused({"check", ball(), "--rig", "vishap"}), HasSubstr("an [arm]"));
}

TEST_F(Camera, AFolderThatIsNoSequenceIsOneLine) {
  const std::string rig = images_rig(path("nowhere"));
  EXPECT_THAT(refused({"run", kScene, "--rig", rig, "--for-s", "1"}, 3),
              AllOf(testing::StartsWith(rig + ":"), HasSubstr(":1: camera: "),
                    HasSubstr("nowhere: is not there; expected a folder of images or a video")));
}

// A recorded sequence gives equal results every time, however busy the machine is.
TEST_F(Camera, AFolderRepeatsToTheBit) {
  const std::string folder = path("frames");
  std::filesystem::create_directory(folder);
  for (int i = 10; i < 30; ++i)
    for (const char* side : {"left", "right"}) {
      Image image(640, 480);
      std::fill(image.rgb.begin(), image.rgb.end(), static_cast<std::uint8_t>(4 * i));
      std::ofstream(folder + "/" + side + std::to_string(i) + ".png", std::ios::binary) << sim::png(image);
    }
  const Words words{"run", kScene, "--rig", images_rig(folder), "--for-s", "0.9"};
  const Result once = run_program(words), again = run_program(words);
  EXPECT_EQ(once.code, 0) << once.err << once.out;
  EXPECT_FALSE(line_of(once.out, "state hash").empty()) << once.out;
  EXPECT_EQ(line_of(once.out, "state hash"), line_of(again.out, "state hash"));
  EXPECT_THAT(once.out, Not(HasSubstr("came late")));

  const Result few = run_program({"run", kScene, "--rig", images_rig(folder), "--for-s", "0.2"});
  EXPECT_THAT(few.out, HasSubstr("the background was not learned, of which 5 frames came"));
  Words half = words;
  for (const char* set : {"rig.camera.width_px=320", "rig.camera.left.centre_px=[160, 240]",
                          "rig.camera.right.centre_px=[160, 240]"})
    half.insert(half.end(), {"--set", set});
  EXPECT_THAT(refused(half), HasSubstr("640 x 480 px and the rig file says 320 x 480 px"));
}

// check refuses whatever run would refuse, with the same words.
TEST_F(Camera, NumbersThatDoNotFitEachOtherAreSaidByCheck) {
  const auto line = [&](const std::string& set) { return refused({"check", kScene, "--set", set}); };
  EXPECT_THAT(line("rig.vision.median_px=4"), HasSubstr("the side of the median filter is even"));
  EXPECT_THAT(line("rig.vision.block_rows_px=6"), HasSubstr("a block has 6 rows; expected 3, 5, 7"));
  EXPECT_THAT(line("rig.vision.block_columns_px=9"), HasSubstr("expected 8, 12 or 16"));
  EXPECT_THAT(line("rig.vision.nearest_mm=50"), HasSubstr("raise 'nearest_mm'"));
  EXPECT_THAT(line("rig.vision.farthest_mm=100"), HasSubstr("'farthest_mm' is not beyond"));
  EXPECT_THAT(line("rig.camera.latency_ms=5000"), HasSubstr("more than 60 frames are on their way"));
  EXPECT_THAT(line("rig.vision.search_px=[700, 0, 800, 100]"), HasSubstr("outside of the image"));
  EXPECT_THAT(line("truth.camera.noise_of_255=31"), HasSubstr("noise_of_255"));
  EXPECT_THAT(line("truth.camera.width_px=320"),
              HasSubstr("the rig's images are 640 x 480 px and the twin's 320 x 480"));
}

// A rig with a calibration file uses all of its numbers, reports any number beside it, and names the file.
TEST_F(Camera, ACalibrationSaysAllAndIsNamed) {
  write("models/rigs/head.toml",
        "format = 1\ntitle = \"13 pairs\"\nwidth_px = 640\nheight_px = 480\n\n"
        "[left]\nfocal_px = [700.5, 700]\ncentre_px = [318.25, 241.5]\n"
        "distortion = [-0.1, 0.02, 0, 0, 0]\n\n"
        "[right]\nfocal_px = [701, 701.5]\ncentre_px = [320, 240]\n"
        "distortion = [-0.1, 0.02, 0, 0, 0]\nposition_mm = [90.1, 0.2, -0.1]\n"
        "rotation_deg = [0.1, -0.4, 0.03]\n");
  const std::string own =
      replaced(test::bytes_of(path("models/rigs/vishap.toml")), "rate_hz = 20\nlatency_ms = 50\n\n[vision]",
               "rate_hz = 20\nlatency_ms = 50\ncalibration = \"head.toml\"\n\n[vision]");
  const std::string rig = path("models/rigs/mine.toml");
  write("models/rigs/mine.toml", own);
  const Result params = run_program({"params", kScene, "--rig", rig});
  EXPECT_THAT(params.out,
              AllOf(HasSubstr("\nrig.camera.calibration,,head.toml,"),
                    HasSubstr("\nrig.camera.left.focal_px,px,\"[700.5, 700]\",head.toml,derived,"),
                    HasSubstr("\nrig.camera.rate_hz,Hz,20,[VisHap 2.3.1],")))
      << params.err;

  const Result resolved = run_program({"check", kScene, "--rig", rig, "--resolved"});
  EXPECT_THAT(resolved.out.substr(0, resolved.out.find('\n')), HasSubstr("mine.toml, camera by head.toml"));
  write("alone.toml", resolved.out);
  const std::string hash = line_of(run({"--rig", rig, "--for-s", "1"}).out, "state hash");
  EXPECT_FALSE(hash.empty());
  EXPECT_EQ(line_of(run_program({"run", path("alone.toml"), "--for-s", "1"}).out, "state hash"), hash);

  EXPECT_THAT(refused({"check", kScene, "--rig", rig, "--set", "rig.camera.left.focal_px=[800, 800]"}),
              AllOf(HasSubstr("--set rig.camera.left.focal_px=[800, 800]: "),
                    HasSubstr("by the calibration 'head.toml'; expected one of the two")));
  write("models/rigs/mine.toml", replaced(own, "calibration =", "width_px = 320\ncalibration ="));
  const std::string place = line_and_column(test::bytes_of(rig), "width_px = 320");
  EXPECT_THAT(refused({"check", kScene, "--rig", rig}),
              HasSubstr(rig + ":" + place + ": rig.camera.width_px is said here and by the calibration"));
}

TEST_F(Camera, APictureIsDrawnWithoutVision) {
  const Result r = run_program({"view", kScene, "--at-s", "0.5", "--shot", path("wall.png")});
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.err, HasSubstr("drawn without vision"));
  EXPECT_THAT(test::bytes_of(path("wall.png")), testing::StartsWith("\x89PNG"));
}

TEST_F(Camera, ATrueLensHasFiveNumbers) {
  EXPECT_THAT(refused({"check", kScene, "--set", "truth.camera.distortion=[-0.1, 0.02]"}),
              HasSubstr("has 2 elements; expected 5 numbers"));
}

TEST_F(Camera, DoctorSaysWhatVisionNeeds) {
  const Result there = run_program({"doctor"}), bare = run_program({"doctor"}, {{"PATH", "/nowhere"}});
  EXPECT_THAT(there.out, AllOf(HasSubstr("\nok      vision, for scenes with a camera (module vision)\n"),
                               HasSubstr("OpenCV, for calibration from images (module calibration)")));
  EXPECT_THAT(bare.out, HasSubstr("\nnote    ffmpeg, for videos as a stereo camera: apt-get install ffmpeg"));
}

TEST_F(Camera, AWrongKeyOfVisionIsSaidWithItsPlace) {
  EXPECT_THAT(refused({"check", kScene, "--set", "rig.vision.tile_px=0"}), HasSubstr("tile_px"));
  EXPECT_THAT(refused({"check", kScene, "--set", "rig.vision.tile=5"}), HasSubstr("did you mean"));
  EXPECT_THAT(
      refused({"check", kScene, "--set", "rig.camera.left.centre_px=[900, 10]"}),
      AllOf(HasSubstr("left.centre_px is 900, 10"), HasSubstr("a place in an image of 640 x 480 px")));
  EXPECT_THAT(refused({"check", kScene, "--set", "rig.camera.right.position_mm=[-90, 0, 0]"}),
              HasSubstr("a camera to the right of the left one"));
}

// The left image, the image without the arm, and the image with the wall: three pictures of one moment.
TEST_F(Camera, TheViewThroughItIsRawWithoutTheArmOrAugmented) {
  std::string before;
  for (const char* what : {"raw", "removed", "augmented"}) {
    const std::string shot = path(std::string(what) + ".png");
    const Result result =
        run_program({"view", kScene, "--through-camera", what, "--at-s", "1.5", "--shot", shot});
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("640 x 480 pixels, the left camera's at 1.5"));
    const std::string png = test::bytes_of(shot);
    EXPECT_GT(png.size(), 100'000U);
    EXPECT_NE(png, before);
    before = png;
  }
}

TEST_F(Camera, AViewThroughNoCameraIsRefusedInOneLine) {
  const std::string wall = tests::source_dir() + "/models/scenes/wall.toml";
  const Result none = run_program({"view", wall, "--through-camera", "raw", "--shot", path("a.png")});
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, AllOf(HasSubstr("wall.toml:1:1: the scene has no camera"), HasSubstr("[camera]")));
  EXPECT_EQ(std::count(none.err.begin(), none.err.end(), '\n'), 1);
  const Result unknown = run_program({"view", kScene, "--through-camera", "xray", "--shot", path("a.png")});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("augmented"));
  EXPECT_FALSE(std::filesystem::exists(path("a.png")));
}

}  // namespace
}  // namespace enc::tests
