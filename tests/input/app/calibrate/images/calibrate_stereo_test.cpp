// `encounter calibrate stereo` as a person uses it: drawn pairs of a board in, a head out; and one line for
// every folder that is none.
#include <algorithm>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "hw_drivers/images/files/image_file.h"
#include "models/setup/stereo_file.h"
#include "sim/picture/picture.h"
#include "tests/support/bytes_of.h"
#include "tests/support/one_line.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/vision/chessboard.h"

namespace enc::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

const Board kBoard{9, 6, 0.024};

// Drawn once for all tests, which copy them.
const std::vector<test::DrawnPair>& drawn_pairs() {
  static const std::vector<test::DrawnPair> kPairs = [] {
    std::vector<test::DrawnPair> pairs;
    for (const Pose<'C', 'O'>& X_CO : test::tilted_boards(kBoard, 6))
      pairs.push_back(test::drawn(test::known_head(320, 240), kBoard, X_CO));
    return pairs;
  }();
  return kPairs;
}

class CalibrateStereo : public testing::Test {
 protected:
  CalibrateStereo() { fs::create_directory(folder_); }
  [[nodiscard]] std::string file(const std::string& name) const { return folder_ + "/" + name; }
  void put(const std::string& name, const Image& image) const {
    std::ofstream(file(name), std::ios::binary) << sim::png(image);
  }
  void put_all() const {
    for (std::size_t i = 0; i < drawn_pairs().size(); ++i) {
      put("left" + std::to_string(i) + ".png", drawn_pairs()[i].left);
      put("right" + std::to_string(i) + ".png", drawn_pairs()[i].right);
    }
  }
  [[nodiscard]] Result calibrate(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"calibrate", "stereo", folder_, "--square-mm", "24"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words, {});
  }
  // What a search says with exit code 2, behind lines on how far it is.
  [[nodiscard]] std::string refusal(const std::vector<std::string>& more) const {
    const Result r = calibrate(more);
    EXPECT_EQ(r.code, 2) << r.out;
    EXPECT_EQ(r.out, "");
    return r.err;
  }
  // What one line on stderr says, with exit code 2.
  [[nodiscard]] std::string line(const std::vector<std::string>& more = {}) const {
    return one_line(calibrate(more));
  }
  test::TemporaryFolder temporary_;
  std::string folder_ = temporary_.file("pairs");
};

TEST_F(CalibrateStereo, FindsTheHeadAndWritesWhatARigReads) {
  put_all();
  const std::string out = temporary_.file("head.toml"), picture = temporary_.file("head.png");
  const Result r = calibrate({"--out", out, "--picture", picture});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, AllOf(HasSubstr("6 pairs of 320 x 240 px, board 9 x 6, squares of 24 mm"),
                           HasSubstr("left5.png"), HasSubstr("rectified   rows differ by"),
                           HasSubstr(": within 0.6 px"), HasSubstr("squares     are right within"),
                           HasSubstr("images      left0.png with right0.png, and 5 more")));
  EXPECT_THAT(test::bytes_of(out),
              testing::ContainsRegex("^# Encounter [0-9.]+: ./encounter calibrate stereo " + folder_ +
                                     " --square-mm 24 --corners 9x6\nformat = 1\n"));
  const StereoRig found = models::load_stereo(out), is = test::known_head(320, 240);
  // Drawn corners are found to 0.1 px, by which a board a third of the image wide tells lengths to 1 %.
  EXPECT_NEAR(found.left.focal_x, is.left.focal_x, 0.01 * is.left.focal_x);
  EXPECT_NEAR(found.X_CD.p().norm(), is.X_CD.p().norm(), 0.01 * is.X_CD.p().norm());
  Image image;
  images::read_image(picture, image);
  EXPECT_EQ(image.width, 640);
  // And once more: nothing is written over, and the same images give the same file.
  EXPECT_THAT(line({"--out", out}), HasSubstr("is there already"));
  const std::string text = test::bytes_of(out);
  EXPECT_EQ(calibrate({"--out", out, "--force"}).code, 0);
  EXPECT_EQ(test::bytes_of(out), text);
}

TEST_F(CalibrateStereo, JsonIsOneObject) {
  put_all();
  const Result r = calibrate({"--json"});
  ASSERT_EQ(r.code, 0) << r.err;
  const nlohmann::json json = nlohmann::json::parse(r.out);
  EXPECT_EQ(json["pairs"].size(), 6U);
  EXPECT_LT(json["epipolar_px"], 0.3);
  EXPECT_EQ(json["within"], true);
  EXPECT_EQ(json["k3_fitted"], false);
}

TEST_F(CalibrateStereo, AnImageIsNeverWrittenOver) {
  put_all();
  const std::string before = test::bytes_of(file("left0.png"));
  EXPECT_THAT(line({"--out", file("left0.png"), "--force"}), HasSubstr("is read by this command"));
  EXPECT_EQ(test::bytes_of(file("left0.png")), before);
}

TEST_F(CalibrateStereo, FilesThatAPersonCannotMeanAreRefused) {
  put_all();
  const std::string out = temporary_.file("head.toml"), same = folder_ + "/../head.toml";
  EXPECT_THAT(line({"--out", out, "--picture", same}), HasSubstr("is both --out and --picture"));
  EXPECT_THAT(line({"--out", "-"}), HasSubstr("--out: '-' is no name of a file"));
  EXPECT_THAT(line({"--picture", "-"}), HasSubstr("--picture: '-' is no name of a file"));
  EXPECT_THAT(line({"--picture", temporary_.file("head.JPG")}), HasSubstr("a name that ends in .png"));
  EXPECT_THAT(line({"--picture", file("rows.png")}), HasSubstr("rows.png: is among the images"));
  EXPECT_FALSE(fs::exists(out) || fs::exists(file("rows.png")));
}

// What would move the cursor of a terminal, or change its colours, is not printed.
TEST_F(CalibrateStereo, NamesArePrintedWithoutControlCharacters) {
  put_all();
  fs::rename(file("left2.png"), file("left2\033[31m.png"));
  fs::rename(file("right2.png"), file("right2\033[31m.png"));
  const Result r = calibrate();
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, AllOf(HasSubstr("left2\\x1b[31m.png"), testing::Not(HasSubstr("\033"))));
  fs::remove(file("right2\033[31m.png"));
  EXPECT_THAT(line(),
              AllOf(HasSubstr("left2\\x1b[31m.png: has no right image"), testing::Not(HasSubstr("\033"))));
}

TEST_F(CalibrateStereo, WhatIsNoFolderIsSaidAsWhatItIs) {
  put_all();
  const auto of = [](const std::string& what, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"calibrate", "stereo", what};
    words.insert(words.end(), more.begin(), more.end());
    const Result r = run_program(words, {});
    EXPECT_EQ(r.code, 2) << r.out;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    return r.err;
  };
  const std::vector<std::string> board{"--square-mm", "24"};
  for (const auto& more : {board, {}})
    EXPECT_THAT(of(file("left0.png"), more), HasSubstr("is a single image"));
  EXPECT_THAT(of(folder_ + "x", board), HasSubstr("pairsx: is not there; expected a folder of images"));
  EXPECT_THAT(of("pairsx", board), HasSubstr("pairsx: is not there; expected a folder of images"));
  EXPECT_THAT(of("vishap"), HasSubstr("vishap: is not there; expected a folder of images"));
  std::ofstream(temporary_.file("notes.txt")) << "no log";
  EXPECT_THAT(of(temporary_.file("notes.txt"), board), HasSubstr("notes.txt: is a file; expected a folder"));
}

TEST_F(CalibrateStereo, EachFolderThatIsNoneIsOneLine) {
  EXPECT_THAT(line(), HasSubstr("has no images"));
  put_all();
  fs::remove(file("right3.png"));
  EXPECT_THAT(line(), AllOf(HasSubstr("left3.png"), HasSubstr("has no right image")));
  put("right3.png", Image(320, 200));
  EXPECT_THAT(line(), AllOf(HasSubstr("right3.png"), HasSubstr("is 320 x 200 px")));
  put("right3.png", drawn_pairs()[3].right);
  fs::resize_file(file("left2.png"), fs::file_size(file("left2.png")) / 2);
  EXPECT_THAT(line(), AllOf(HasSubstr("left2.png"), HasSubstr("cut off")));
}

TEST_F(CalibrateStereo, BoardsThatAreNotThereAreNamed) {
  put_all();
  for (const char* name : {"left1.png", "right4.png", "left5.png"}) put(name, Image(320, 240));
  EXPECT_THAT(line(), AllOf(HasSubstr("found in 3 pairs; expected at least 4"),
                            HasSubstr("none in left1.png, right4.png, left5.png")));
  EXPECT_THAT(line({"--corners", "seven"}), HasSubstr("such as 9x6"));
}

// Whoever counts squares, or one corner too few, is told the number of corners.
TEST_F(CalibrateStereo, ABoardOfAnotherSizeIsNamed) {
  put_all();
  for (const char* corners : {"10x7", "8x6", "7x7"})
    EXPECT_THAT(refusal({"--corners", corners}),
                AllOf(HasSubstr("left0.png has a board of 9 x 6: count inner corners"),
                      HasSubstr("give --corners 9x6")))
        << corners;
  EXPECT_EQ(calibrate({"--corners", "6x9"}).code, 0);
}

TEST_F(CalibrateStereo, WhereNoPairHasABoardTheSearchEnds) {
  for (int i = 0; i < 12; ++i)
    for (const char* side : {"left", "right"}) put(side + std::to_string(i) + ".png", Image(320, 240));
  EXPECT_THAT(refusal({"--corners", "10x7"}),
              HasSubstr("a board of 10 x 7 inner corners was found in 0 pairs"));
}

// A board may come into view late.
TEST_F(CalibrateStereo, TwoPairsWithoutABoardDoNotEndTheSearch) {
  for (std::size_t i = 0; i < drawn_pairs().size(); ++i) {
    put("left" + std::to_string(i + 3) + ".png", drawn_pairs()[i].left);
    put("right" + std::to_string(i + 3) + ".png", drawn_pairs()[i].right);
  }
  for (const char* name : {"left0.png", "right0.png", "left1.png", "right1.png", "left2.png", "right2.png"})
    put(name, Image(320, 240));
  const Result r = calibrate();
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, HasSubstr("6 pairs of 320 x 240 px"));
}

// Images of one camera, whose names say no side, would be cut through the board.
TEST_F(CalibrateStereo, OneCameraIsNotReadAsTwoHalves) {
  for (std::size_t i = 0; i < drawn_pairs().size(); ++i)
    put(std::to_string(i) + ".png", drawn_pairs()[i].left);
  EXPECT_THAT(refusal({}), AllOf(HasSubstr("0.png shows one board across its middle"),
                                 HasSubstr("expected images of two cameras")));
}

// Nothing is called good, and no file is written, where the lens is not of the model.
TEST_F(CalibrateStereo, AFisheyeEndsWithExitCode1AndNoFile) {
  StereoRig head = test::known_head(480, 360);
  for (Lens* lens : {&head.left, &head.right}) lens->focal_x *= 0.6, lens->focal_y *= 0.6;
  const auto boards = test::boards_all_over(head, kBoard, 9, test::Bend::fisheye);
  for (std::size_t i = 0; i < boards.size(); ++i) {
    const test::DrawnPair pair = test::drawn(head, kBoard, boards[i], test::Bend::fisheye);
    put("left" + std::to_string(i) + ".png", pair.left);
    put("right" + std::to_string(i) + ".png", pair.right);
  }
  const std::string out = temporary_.file("head.toml");
  const Result r = calibrate({"--out", out});
  EXPECT_EQ(r.code, 1) << r.err;
  EXPECT_THAT(r.out, AllOf(HasSubstr("NOT within 0.6 px"), HasSubstr("unfit       rows of left"),
                           HasSubstr("not written " + out)));
  EXPECT_FALSE(fs::exists(out));
  const Result json = calibrate({"--json", "--out", out});
  EXPECT_EQ(json.code, 1);
  EXPECT_EQ(nlohmann::json::parse(json.out)["within"], false);
  EXPECT_FALSE(fs::exists(out));
}

// A pair that a longer baseline has taken keeps its rows: its squares alone say so.
TEST_F(CalibrateStereo, SquaresThatErrAreNoted) {
  put_all();
  StereoRig longer = test::known_head(320, 240);
  longer.X_CD = Pose<'C', 'D'>(longer.X_CD.q(), Vec3(1.015 * longer.X_CD.p()));
  const test::DrawnPair pair = test::drawn(longer, kBoard, test::tilted_boards(kBoard, 6)[3]);
  put("left3.png", pair.left), put("right3.png", pair.right);
  const Result r = calibrate();
  EXPECT_EQ(r.code, 0) << r.out << r.err;
  EXPECT_THAT(r.out,
              testing::ContainsRegex(
                  "note        squares err by more than 0.5 %.*left3.png \\(1\\.[0-9]+ % too small\\)"));
}

TEST_F(CalibrateStereo, PairsThatDoNotGoTogetherAreNamed) {
  put_all();
  put("right2.png", drawn_pairs()[4].right);
  EXPECT_THAT(line(), AllOf(HasSubstr("do not go together"), HasSubstr("without left2.png")));
}

TEST_F(CalibrateStereo, OptionsOfAnotherSubjectAreRefused) {
  for (const char* option : {"--frames=3", "--masks=m", "--seed=1", "--rate-Hz=100", "--set=a=1", "--skin=m"})
    EXPECT_THAT(line({option}), HasSubstr("not expected: " + std::string(option)));
  EXPECT_THAT(run_program({"calibrate", "stereo", folder_}, {}).err,
              HasSubstr("has no images"));  // before all else
  put_all();
  const Result none = run_program({"calibrate", "stereo", folder_}, {});
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, HasSubstr("--square-mm 25"));
}

}  // namespace
}  // namespace enc::tests
