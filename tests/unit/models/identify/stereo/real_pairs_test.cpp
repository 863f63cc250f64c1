// The 13 real pairs of chessboards of Debian's opencv-doc (./check fetches them into .deps/chessboards): the
// whole way from files to a head, judged by pairs that the calibration has not seen.
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "hw_drivers/images/files/pair_list.h"
#include "models/identify/stereo/stereo_calibration.h"
#include "tests/support/built.h"

namespace enc {
namespace {

const std::string kFolder = tests::source_dir() + "/.deps/chessboards";
const Board kBoard{9, 6, 0.025};  // the sheet's squares are of no known size; this one is for the report

std::vector<PairCorners> real_pairs() {
  images::PairReader reader(images::list_pairs(kFolder, images::Layout::pairs));
  std::vector<PairCorners> pairs;
  images::ImagePair images;
  for (std::size_t i = 0; i < reader.list().pairs.size(); ++i) {
    reader.read(i, images);
    const std::optional<Corners> left = find_corners(images.left.view(), kBoard);
    const std::optional<Corners> right = find_corners(images.right.view(), kBoard);
    EXPECT_TRUE(left && right) << reader.list().pairs[i].left;
    if (left && right) pairs.push_back(in_one_order(*left, *right, kBoard));
  }
  return pairs;
}

TEST(RealPairs, AHeadThatFitsPairsThatItHasNotSeen) {
  if (!std::filesystem::exists(kFolder))
    GTEST_SKIP() << "no pairs of chessboards in " << kFolder << ": ./check fetches them";
  const std::vector<PairCorners> pairs = real_pairs();
  ASSERT_EQ(pairs.size(), 13U);
  const StereoCalibration found = calibrate_stereo(pairs, kBoard, 640, 480);
  fmt::print("{:>4}{:>12}{:>12}{:>14}{:>10}{:>14}\n", "pair", "left, px", "right, px", "epipolar, px",
             "rows, px", "square, mm");
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const PairResidual& p = found.pairs[i];
    fmt::print("{:>4}{:>12.3f}{:>12.3f}{:>14.3f}{:>10.3f}{:>14.3f}\n", i + 1, p.left, p.right, p.epipolar,
               p.rows, p.square * 1e3);
    EXPECT_LE(p.epipolar, 0.6) << i + 1;
    EXPECT_LE(p.rows, 0.6) << i + 1;
    EXPECT_NEAR(p.square, kBoard.square, 0.01 * kBoard.square) << i + 1;
  }
  fmt::print("all: rms {:.3f} px; left out: epipolar {:.3f}, rows {:.3f} px\n", found.rms, found.epipolar,
             found.rows);
  EXPECT_EQ(found.k3, K3::zero);  // of the right lens k3 is 2.5 deviations from 0
  EXPECT_LE(found.rms, 0.6);
  EXPECT_LE(found.epipolar, 0.6);
  EXPECT_LE(found.rows, 0.6);
}

// Whoever counts squares or misses a row is told how many corners the sheet has, and no part of it passes for
// a board.
TEST(RealPairs, ABoardOfAnotherSizeIsMeasured) {
  if (!std::filesystem::exists(kFolder)) GTEST_SKIP() << "no pairs of chessboards in " << kFolder;
  images::PairReader reader(images::list_pairs(kFolder, images::Layout::pairs));
  images::ImagePair images;
  reader.read(0, images);
  for (const auto& [columns, rows] : {std::pair{10, 7}, {8, 5}, {8, 6}, {9, 5}, {7, 8}}) {
    const Board wrong{columns, rows, kBoard.square};
    EXPECT_FALSE(find_corners(images.left.view(), wrong)) << columns << "x" << rows;
    const std::optional<Board> is = board_in(images.left.view(), wrong);
    ASSERT_TRUE(is) << columns << "x" << rows;
    EXPECT_EQ(is->columns, 9);
    EXPECT_EQ(is->rows, 6);
  }
}

// The epipolar error is of the head and not of the image: a head that is turned by half a degree has 4.6 px.
TEST(RealPairs, AWrongHeadDoesNotFit) {
  if (!std::filesystem::exists(kFolder)) GTEST_SKIP() << "no pairs of chessboards in " << kFolder;
  const std::vector<PairCorners> pairs = real_pairs();
  StereoRig rig = calibrate_stereo(pairs, kBoard, 640, 480).rig;
  rig.X_CD =
      Pose<'C', 'D'>(rig.X_CD.q() * Quat(Eigen::AngleAxisd(M_PI / 360.0, Vec3::UnitX())), Vec3(rig.X_CD.p()));
  for (const PairCorners& pair : pairs) EXPECT_NEAR(residual_of(rig, pair, kBoard).epipolar, 4.67, 0.6);
}

}  // namespace
}  // namespace enc
