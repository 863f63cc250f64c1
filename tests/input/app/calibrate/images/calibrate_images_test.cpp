// `encounter calibrate stereo` and `encounter calibrate skin` as a person uses them: drawn images in, a
// calibration out; and mistakes, one line each.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/image.h"
#include "hw_drivers/images/files/image_file.h"
#include "models/setup/calibration_files.h"
#include "sim/picture/picture.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"
#include "tests/support/vision/chessboard.h"

namespace enc::tests {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

// ---- `encounter calibrate stereo` as a person uses it: drawn pairs of a board in, a head out; and one line
// for every unusable folder.

const Board kBoard{9, 6, 0.024};

// Drawn once; all tests copy them.
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
  // The message of a search that ends with exit code 2, behind lines on its progress.
  [[nodiscard]] std::string refusal(const std::vector<std::string>& more) const {
    const Result r = calibrate(more);
    EXPECT_EQ(r.code, 2) << r.out;
    EXPECT_EQ(r.out, "");
    return r.err;
  }
  // The single line on stderr, with exit code 2.
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
  // The search finds drawn corners to 0.1 px, so a board a third of the image wide determines lengths to 1 %.
  EXPECT_NEAR(found.left.focal_x, is.left.focal_x, 0.01 * is.left.focal_x);
  EXPECT_NEAR(found.X_CD.p().norm(), is.X_CD.p().norm(), 0.01 * is.X_CD.p().norm());
  Image image;
  images::read_image(picture, image);
  EXPECT_EQ(image.width, 640);
  // A second call overwrites nothing, and the same images give the same file.
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

// The program does not print characters that would move a terminal's cursor or change its colours.
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

// The message gives the number of corners to a person who counts squares, or one corner too few.
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

// Images of one camera, whose names give no side, would be cut through the board.
TEST_F(CalibrateStereo, OneCameraIsNotReadAsTwoHalves) {
  for (std::size_t i = 0; i < drawn_pairs().size(); ++i)
    put(std::to_string(i) + ".png", drawn_pairs()[i].left);
  EXPECT_THAT(refusal({}), AllOf(HasSubstr("0.png shows one board across its middle"),
                                 HasSubstr("expected images of two cameras")));
}

// The command accepts no result and writes no file if the lens does not fit the model.
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

// A pair that a longer baseline has taken keeps its rows: only its squares reveal it.
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
              HasSubstr("has no images"));  // before every other check
  put_all();
  const Result none = run_program({"calibrate", "stereo", folder_}, {});
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, HasSubstr("--square-mm 25"));
}

// ---- `encounter calibrate skin` as a person uses it: skin drawn with a known hue and spread in, the lines
// of a rig out; and one line for every unusable folder.

constexpr int kWidth = 240, kHeight = 160;
constexpr std::uint32_t kSeed = 41'000;  // differs from those of all benchmarks and other tests

// A bright colour of this hue, half saturated like skin.
void paint(std::uint8_t* rgb, double degrees) {
  for (int c = 0; c < 3; ++c) {
    const double away = std::abs(std::remainder(degrees - 120.0 * c, 360.0)) / 60.0;
    rgb[c] = static_cast<std::uint8_t>(std::lround(40.0 + 200.0 * std::clamp(2.0 - away, 0.0, 1.0)));
  }
}

struct Hand {
  Image image{kWidth, kHeight}, mask{kWidth, kHeight};
};
// An ellipse of skin before a wall of hue 200; a stripe of it is grey, another one dark.
Hand hand_of(double hue, double spread, std::uint32_t seed) {
  Hand hand;
  std::mt19937 random(kSeed + seed);
  std::normal_distribution<double> gauss;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double a = (x - 120.0) / 100.0, b = (y - 80.0) / 70.0;
      std::uint8_t* p = hand.image.at(x, y);
      paint(p, 200.0);
      if (a * a + b * b >= 1.0) continue;
      std::fill_n(hand.mask.at(x, y), 3, std::uint8_t{255});
      paint(p, hue + spread * gauss(random));
      if (x == 100) std::fill_n(p, 3, std::uint8_t{90});
      if (x == 101) p[0] = 15, p[1] = 4, p[2] = 0;
    }
  return hand;
}

class CalibrateSkin : public testing::Test {
 protected:
  CalibrateSkin() {
    fs::create_directory(images_);
    fs::create_directory(masks_);
  }
  static void put(const std::string& file, const Image& image) {
    std::ofstream(file, std::ios::binary) << sim::png(image);
  }
  [[nodiscard]] std::string image(const std::string& name) const { return images_ + "/" + name; }
  [[nodiscard]] std::string mask(const std::string& name) const { return masks_ + "/" + name; }
  void put_all(double hue = 17.0, double spread = 4.0) const {
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Hand hand = hand_of(hue, spread, i);
      put(image(std::to_string(i) + ".png"), hand.image);
      put(mask(std::to_string(i) + ".png"), hand.mask);
    }
  }
  [[nodiscard]] Result calibrate(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"calibrate", "skin", images_, "--masks", masks_};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words, {});
  }
  // The single line on stderr, with exit code 2.
  [[nodiscard]] std::string line(const std::vector<std::string>& more = {}) const {
    return one_line(calibrate(more));
  }
  test::TemporaryFolder temporary_;
  std::string images_ = temporary_.file("images"), masks_ = temporary_.file("masks");
};

// The mean deviates by 1 % where it is not 0; 88,000 pixels determine the spread to 0.24 %.
TEST_F(CalibrateSkin, IsWhatItWasDrawnWith) {
  for (const auto& [hue, spread] : {std::pair{17.0, 4.0}, {1.0, 6.0}, {358.0, 3.0}, {28.0, 2.0}}) {
    put_all(hue, spread);
    const Result r = calibrate({"--json"});
    ASSERT_EQ(r.code, 0) << r.err;
    const nlohmann::json found = nlohmann::json::parse(r.out);
    const double error = std::remainder(found["skin_hue_deg"].get<double>() - hue, 360.0);
    EXPECT_LT(std::abs(error), 0.01 * std::max(std::min(hue, 360.0 - hue), spread)) << r.out;
    EXPECT_NEAR(found["skin_spread_deg"].get<double>(), spread, 0.01 * spread) << r.out;
    EXPECT_GE(found["skin_hue_deg"].get<double>(), 0.0);
    const nlohmann::json& pixels = found["pixels"];
    EXPECT_EQ(pixels["hand"].get<int>() + pixels["rest"].get<int>(), 4 * kWidth * kHeight);
    EXPECT_EQ(pixels["hand"].get<int>(),
              pixels["learned"].get<int>() + pixels["grey"].get<int>() + pixels["dark"].get<int>());
    EXPECT_EQ(pixels["grey"], pixels["dark"]);  // a column each
    EXPECT_GT(pixels["grey"], 4 * 100);
    // 98.76 % of a Gaussian lie within 2.5 spreads; the wall is far away.
    const nlohmann::json& usual = found["roc"][2];
    EXPECT_EQ(usual["skin_sigmas"], 2.5);
    const double share = pixels["learned"].get<double>() / pixels["hand"].get<double>();
    EXPECT_NEAR(usual["of_hand"].get<double>(), 0.9876 * share, 0.003) << hue;
    EXPECT_EQ(usual["of_rest"], 0.0);
    EXPECT_TRUE(found["unlike"].empty());
  }
}

TEST_F(CalibrateSkin, WritesWhatARigReads) {
  put_all();
  const std::string out = temporary_.file("skin.toml");
  const Result r = calibrate({"--out", out});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, AllOf(HasSubstr("4 images; "), HasSubstr("grey (chroma below 12 of 255)"),
                           HasSubstr("set         rig.vision.skin_hue_deg = "), HasSubstr("default")));
  EXPECT_THAT(line({"--out", out}), HasSubstr("is there already"));
  EXPECT_EQ(calibrate({"--out", out, "--force"}).code, 0);
  EXPECT_THAT(test::bytes_of(out),
              testing::ContainsRegex("^# Encounter [0-9.]+: ./encounter calibrate skin " + images_ +
                                     " --masks " + masks_ + "\n"));
  // The lines replace the rig's own table.
  const std::string models = tests::source_dir() + "/models", table = test::bytes_of(out);
  std::string rig = test::bytes_of(models + "/rigs/vishap.toml");
  const std::size_t from = rig.find("[vision]"), to = rig.find("\n[", from);
  rig.replace(from, to - from, table);
  const std::string file = temporary_.file("rig.toml");
  std::ofstream(file) << rig;
  const Result params =
      run_program({"params", models + "/scenes/camera/wall.toml", "--rig", file, "--json"}, {});
  ASSERT_EQ(params.code, 0) << params.err;
  const nlohmann::json found = nlohmann::json::parse(calibrate({"--json"}).out);
  int compared = 0;
  for (const nlohmann::json& each : nlohmann::json::parse(params.out)) {
    const std::string name = each["name"];
    if (!name.starts_with("rig.vision.skin_") || !name.ends_with("_deg")) continue;
    EXPECT_EQ(std::stod(each["value"].get<std::string>()), found[name.substr(11)].get<double>()) << table;
    ++compared;
  }
  EXPECT_EQ(compared, 2);
}

TEST_F(CalibrateSkin, AMaskThatIsNotOfTheHandIsSaid) {
  put_all();
  put(image("2.png"), hand_of(150.0, 4.0, 9).image);
  put(image("3.png"), hand_of(17.0, 4.0, 9).image);
  const Result r = calibrate();
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, AllOf(HasSubstr("a spread of"), HasSubstr("more than skin has")));
  for (int i = 4; i < 40; ++i) {
    fs::copy_file(image("3.png"), image(std::to_string(i) + ".png"));
    fs::copy_file(mask("3.png"), mask(std::to_string(i) + ".png"));
  }
  EXPECT_THAT(calibrate().out, HasSubstr("another hue in 2.png: see to the mask"));
}

TEST_F(CalibrateSkin, FilesAreNeverWrittenOver) {
  put_all();
  const std::string before = test::bytes_of(mask("0.png"));
  EXPECT_THAT(line({"--out", mask("0.png"), "--force"}), HasSubstr("is read by this command"));
  EXPECT_EQ(test::bytes_of(mask("0.png")), before);
}

TEST_F(CalibrateSkin, EachFolderThatIsNoneIsOneLine) {
  EXPECT_THAT(line(), AllOf(HasSubstr(images_ + ": has no images")));
  put_all();
  fs::remove(mask("2.png"));
  EXPECT_THAT(line(), AllOf(HasSubstr("2.png: has no mask in"), HasSubstr(masks_)));
  fs::remove(image("2.png"));
  EXPECT_EQ(calibrate().code, 0);
  fs::remove(image("1.png"));
  EXPECT_THAT(line(), AllOf(HasSubstr("1.png: is a mask without its image in"), HasSubstr(images_)));
  fs::remove_all(masks_);
  EXPECT_THAT(line(), AllOf(HasSubstr(masks_ + ": cannot read this folder")));
  fs::create_directory(masks_);
  EXPECT_THAT(line(), AllOf(HasSubstr(masks_ + ": has no images")));
}

TEST_F(CalibrateSkin, EachMaskThatIsNoneIsOneLine) {
  put_all();
  const Hand good = hand_of(17.0, 4.0, 1);
  put(mask("1.png"), Image(kWidth, kHeight - 1));
  EXPECT_THAT(line(), AllOf(HasSubstr("1.png: is 240 x 159 px; expected 240 x 160 as its image")));
  Image flat(kWidth, kHeight);
  put(mask("1.png"), flat);
  EXPECT_THAT(line(), HasSubstr("1.png: has no hand"));
  std::fill(flat.rgb.begin(), flat.rgb.end(), std::uint8_t{255});
  put(mask("1.png"), flat);
  EXPECT_THAT(line(), HasSubstr("1.png: is all hand"));
  put(mask("1.png"), good.image);  // exchanged
  EXPECT_THAT(line(), HasSubstr("1.png: is no mask: "));
  std::ofstream(mask("1.png")) << "no image";
  EXPECT_THAT(line(), HasSubstr("1.png"));
  put(mask("1.png"), good.mask);
  put(mask("1.jpg"), good.mask);
  EXPECT_THAT(line(), HasSubstr("is the same image by its name"));
}

TEST_F(CalibrateSkin, GreyDarkAndPaintedImagesAreRefused) {
  put_all();
  Image image(kWidth, kHeight);
  for (std::size_t i = 0; i < image.rgb.size(); ++i)
    image.rgb[i] = static_cast<std::uint8_t>(60 + i / 3 % 90);
  put(this->image("3.png"), image);
  EXPECT_THAT(line(), AllOf(HasSubstr("3.png: the hand in it has no hue"), HasSubstr("is grey")));
  std::fill(image.rgb.begin(), image.rgb.end(), std::uint8_t{4});
  put(this->image("3.png"), image);
  EXPECT_THAT(line(), AllOf(HasSubstr("3.png: the hand in it has no hue"), HasSubstr("too dark")));
  for (const char* name : {"0.png", "1.png", "2.png", "3.png"})
    put(this->image(name), hand_of(17.0, 0.0, 1).image);
  EXPECT_THAT(line(), HasSubstr("without any spread"));
}

TEST_F(CalibrateSkin, OptionsAndInputsOfAnotherSubjectAreRefused) {
  put_all();
  for (const char* option : {"--square-mm=25", "--corners=9x6", "--picture=a.png", "--frames=3"})
    EXPECT_THAT(line({option}), HasSubstr("not expected: " + std::string(option)));
  EXPECT_THAT(line({"--out", "-"}), HasSubstr("--out: '-' is no name of a file"));
  EXPECT_THAT(one_line(run_program({"calibrate", "skin", images_}, {})), HasSubstr("--masks is required"));
  EXPECT_THAT(one_line(run_program({"calibrate", "skin", image("0.png"), "--masks", masks_}, {})),
              HasSubstr("0.png: is a single image"));
}

}  // namespace
}  // namespace enc::tests
