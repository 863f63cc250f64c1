// Calibration of a stereo head from chessboards: of a head known to the last digit, and of an unknown one.
#include "models/identify/stereo/stereo_calibration.h"

#include <filesystem>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "hw_drivers/images/files/pair_list.h"
#include "tests/support/built.h"
#include "tests/support/refusal.h"
#include "tests/support/vision/chessboard.h"

namespace enc {
namespace {

using test::drawn, test::known_head, test::projected, test::tilted_boards;
using testing::HasSubstr;

const Board kDrawnBoard{9, 6, 0.024};

std::vector<PairCorners> exact_pairs(const StereoRig& rig, std::size_t count) {
  std::vector<PairCorners> pairs;
  for (const Pose<'C', 'O'>& X_CO : tilted_boards(kDrawnBoard, count))
    pairs.push_back(projected(rig, kDrawnBoard, X_CO));
  return pairs;
}

void blur(std::vector<PairCorners>& pairs, double sigma) {
  std::mt19937 engine(7);
  std::normal_distribution<double> noise(0.0, sigma);
  for (PairCorners& pair : pairs)
    for (Corners* corners : {&pair.left, &pair.right})
      for (Eigen::Vector2d& c : *corners) c += Eigen::Vector2d(noise(engine), noise(engine));
}

// Tolerances in px, mm and rad.
void expect_near(const StereoRig& found, const StereoRig& is, double focal, double centre, double place,
                 double turn) {
  for (const auto& [f, i] : {std::pair{found.left, is.left}, {found.right, is.right}}) {
    EXPECT_NEAR(f.focal_x, i.focal_x, focal);
    EXPECT_NEAR(f.focal_y, i.focal_y, focal);
    EXPECT_NEAR(f.centre_x, i.centre_x, centre);
    EXPECT_NEAR(f.centre_y, i.centre_y, centre);
  }
  EXPECT_LT((found.X_CD.p() - is.X_CD.p()).norm() * 1e3, place);
  EXPECT_LT(found.X_CD.q().angularDistance(is.X_CD.q()), turn);
}

std::string refusal(const std::vector<PairCorners>& pairs) {
  return test::refusal([&] { (void)calibrate_stereo(pairs, kDrawnBoard, 640, 480); });
}

// Corners are stored as floats: they resolve only a thousandth of a pixel.
TEST(StereoCalibration, FindsAKnownHeadInExactCorners) {
  const StereoRig is = known_head(640, 480);
  const StereoCalibration found = calibrate_stereo(exact_pairs(is, 10), kDrawnBoard, 640, 480);
  expect_near(found.rig, is, 0.01, 0.01, 0.002, 2e-5);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(found.rig.left.distortion[i], is.left.distortion[i], 1e-3) << i;
    EXPECT_NEAR(found.rig.right.distortion[i], is.right.distortion[i], 1e-3) << i;
  }
  EXPECT_LT(found.rms, 1e-3);
  EXPECT_LT(found.epipolar, 1e-3);
  EXPECT_LT(found.rows, 1e-3);
  ASSERT_EQ(found.pairs.size(), 10U);
  for (const PairResidual& pair : found.pairs) EXPECT_NEAR(pair.square, kDrawnBoard.square, 1e-6);
}

// The error from 0.2 px of noise: three standard deviations of the fit, and residuals equal to the noise. A
// turn of 1 / focal length compensates a centre that is off by a pixel.
TEST(StereoCalibrationLong, SaysHowWellNoisyCornersFit) {
  const StereoRig is = known_head(640, 480);
  std::vector<PairCorners> pairs = exact_pairs(is, 13);
  blur(pairs, 0.2);
  const StereoCalibration found = calibrate_stereo(pairs, kDrawnBoard, 640, 480);
  const double most = 3.0 * found.focal_deviation * is.left.focal_x;
  expect_near(found.rig, is, most, most, 0.5, std::sqrt(2.0) * most / is.left.focal_x);
  EXPECT_NEAR(found.rms, 0.2 * std::sqrt(2.0), 0.02);  // of both coordinates
  EXPECT_GT(found.epipolar, 0.18);                     // the noise of a corner, and of its partner's line
  EXPECT_LT(found.epipolar, 0.34);
  EXPECT_GT(found.rows, found.epipolar * 0.8);
  EXPECT_LT(found.focal_deviation, 0.005);
}

// A pair from another head stands out from the rest, and so it does in the calibration from the others.
TEST(StereoCalibration, APairOfAnotherHeadStandsOut) {
  const StereoRig is = known_head(640, 480);
  std::vector<PairCorners> pairs = exact_pairs(is, 10);
  StereoRig other = is;
  other.X_CD = Pose<'C', 'D'>(is.X_CD.q() * rotation_xyz(Vec3(0.005, 0, 0)), Vec3(is.X_CD.p()));
  pairs[4] = projected(other, kDrawnBoard, tilted_boards(kDrawnBoard, 10)[4]);
  const StereoCalibration found = calibrate_stereo(pairs, kDrawnBoard, 640, 480);
  const double expected = 0.005 * is.right.focal_y;  // px: 2.7
  EXPECT_NEAR(found.pairs[4].epipolar, expected, 0.3);
  EXPECT_NEAR(found.pairs[4].rows, expected, 0.3);
  for (std::size_t i = 0; i < found.pairs.size(); ++i)
    if (i != 4) {
      EXPECT_LT(found.pairs[i].epipolar, 0.5 * expected) << i;
    }
}

// Left and right from different moments: nothing fits, but everything fits without that pair.
TEST(StereoCalibrationLong, APairThatIsNoneIsFound) {
  const StereoRig is = known_head(640, 480);
  std::vector<PairCorners> pairs = exact_pairs(is, 8);
  pairs[2].right = pairs[5].right;
  const StereoCalibration found = calibrate_stereo(pairs, kDrawnBoard, 640, 480);
  EXPECT_GT(found.rms, kLargestRms);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i == 2)
      EXPECT_LT(found.pairs[i].rms, 1e-3);
    else
      EXPECT_GT(found.pairs[i].rms, kLargestRms) << i;
  }
}

TEST(StereoCalibration, CornersOfDrawnBoardsAreFound) {
  const StereoRig is = known_head(640, 480);
  const Pose<'C', 'O'> X_CO = tilted_boards(kDrawnBoard, 3)[2];
  const test::DrawnPair images = drawn(is, kDrawnBoard, X_CO);
  const std::optional<Corners> left = find_corners(images.left.view(), kDrawnBoard);
  const std::optional<Corners> right = find_corners(images.right.view(), kDrawnBoard);
  ASSERT_TRUE(left && right);
  PairCorners found = in_one_order(*left, *right, kDrawnBoard);
  const PairCorners are = projected(is, kDrawnBoard, X_CO);
  if ((found.left.front() - are.left.front()).norm() > 5.0) {  // counted from its far end
    std::reverse(found.left.begin(), found.left.end());
    std::reverse(found.right.begin(), found.right.end());
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < are.left.size(); ++i)
    sum += (found.left[i] - are.left[i]).squaredNorm() + (found.right[i] - are.right[i]).squaredNorm();
  EXPECT_LT(std::sqrt(sum / static_cast<double>(4 * are.left.size())), 0.1);  // px, each coordinate
}

TEST(StereoCalibration, FindsNoBoardWhereThereIsNone) {
  EXPECT_FALSE(find_corners(Image(640, 480).view(), kDrawnBoard));
  EXPECT_FALSE(find_corners(Image(1, 1).view(), kDrawnBoard));
  const test::DrawnPair images = drawn(known_head(320, 240), {8, 6, 0.024}, tilted_boards(kDrawnBoard, 1)[0]);
  EXPECT_FALSE(find_corners(images.left.view(), kDrawnBoard));  // the board has 8 x 6
}

TEST(StereoCalibration, RunsAgainstEachOtherAreTurnedRound) {
  const PairCorners are = projected(known_head(640, 480), kDrawnBoard, tilted_boards(kDrawnBoard, 1)[0]);
  Corners turned = are.right;
  std::reverse(turned.begin(), turned.end());
  EXPECT_EQ(in_one_order(are.left, turned, kDrawnBoard).right, are.right);
  EXPECT_EQ(in_one_order(are.left, are.right, kDrawnBoard).right, are.right);
}

// A square board looks alike from all four sides.
TEST(StereoCalibration, CornersOfASquareBoardAreTurnedRound) {
  const Board square{5, 5, 0.024};
  const PairCorners are = projected(known_head(640, 480), square, tilted_boards(square, 1)[0]);
  Corners turned = are.right;
  for (int quarter = 0; quarter < 4; ++quarter) {
    EXPECT_EQ(in_one_order(are.left, turned, square).right, are.right) << quarter;
    const Corners before = turned;
    for (std::size_t r = 0; r < 5; ++r)
      for (std::size_t c = 0; c < 5; ++c) turned[r * 5 + c] = before[c * 5 + 4 - r];
  }
}

// Noisy corners suffice to find the k3 of a lens, and places are right; a lens without k3 gets none.
double largest_place_error(const StereoRig& found, const StereoRig& is,
                           const std::vector<PairCorners>& pairs) {
  double largest = 0.0;
  for (const PairCorners& pair : pairs) {
    const std::vector<Point<'C'>> a = triangulated(found, pair), b = triangulated(is, pair);
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
  }
  return largest;
}

TEST(StereoCalibrationLong, FitsK3WhereALensHasOne) {
  for (const double k3 : {-0.25, 0.0, 0.3}) {
    SCOPED_TRACE(k3);
    StereoRig is = known_head(640, 480);
    for (Lens* lens : {&is.left, &is.right}) lens->distortion = {-0.02, 0.03, 0.0011, -0.0007, k3};
    std::vector<PairCorners> exact, pairs;
    for (const Pose<'C', 'O'>& X_CO : test::boards_all_over(is, kDrawnBoard, 13))
      exact.push_back(projected(is, kDrawnBoard, X_CO));
    pairs = exact;
    blur(pairs, 0.1);
    const StereoCalibration found = calibrate_stereo(pairs, kDrawnBoard, 640, 480);
    EXPECT_EQ(found.k3, k3 != 0.0 ? K3::fitted : K3::zero);
    EXPECT_NEAR(found.rig.left.distortion[4], k3, 0.1);
    EXPECT_LT(found.rms, 0.16);  // the noise of both coordinates
    EXPECT_LT(largest_place_error(found.rig, is, exact) * 1e3, 3.0);
    for (const PairResidual& pair : found.pairs) {
      EXPECT_LT(pair.rows, 0.3);
      EXPECT_NEAR(pair.square, kDrawnBoard.square, 0.004 * kDrawnBoard.square);
    }
    EXPECT_GT(found.left.reach, 0.7);
    EXPECT_FALSE(found.left.unlike() || found.right.unlike());
  }
}

// The model cannot describe a fisheye: pairs left out do not fit, rings of corners lie off.
TEST(StereoCalibrationLong, AFisheyeDoesNotFit) {
  StereoRig is = known_head(640, 480);
  for (Lens* lens : {&is.left, &is.right}) lens->focal_x *= 0.4, lens->focal_y *= 0.4;
  std::vector<PairCorners> pairs;
  for (const Pose<'C', 'O'>& X_CO : test::boards_all_over(is, kDrawnBoard, 9, test::Bend::fisheye))
    pairs.push_back(projected(is, kDrawnBoard, X_CO, test::Bend::fisheye));
  blur(pairs, 0.1);
  const StereoCalibration found = calibrate_stereo(pairs, kDrawnBoard, 640, 480);
  EXPECT_FALSE(found.rows <= 0.6);
  EXPECT_TRUE(found.left.unlike() && found.right.unlike());
}

// Images with their long side upright, of cameras side by side.
TEST(StereoCalibration, UprightImagesAreCalibrated) {
  const StereoRig is = known_head(480, 640);
  std::vector<PairCorners> pairs = exact_pairs(is, 8);
  const StereoCalibration found = calibrate_stereo(pairs, kDrawnBoard, 480, 640);
  expect_near(found.rig, is, 0.01, 0.01, 0.002, 2e-5);
}

// The search finds the size of a board of another size, and accepts no part of it as the board.
TEST(StereoCalibration, BoardsOfOtherSizesAreMeasured) {
  for (const Board& board : {Board{9, 6, 0.024}, Board{7, 7, 0.024}}) {
    SCOPED_TRACE(board.columns);
    const Image image = drawn(known_head(320, 240), board, tilted_boards(board, 2)[1]).left;
    for (const auto& [columns, rows] : {std::pair{0, -1}, {-1, -1}, {1, 1}}) {
      const Board wrong{board.columns + columns, board.rows + rows, 0.024};
      EXPECT_FALSE(find_corners(image.view(), wrong)) << columns << " " << rows;
      const std::optional<Board> found = board_in(image.view(), wrong);
      ASSERT_TRUE(found) << columns << " " << rows;
      EXPECT_EQ(found->columns, std::max(board.columns, board.rows));
      EXPECT_EQ(found->rows, std::min(board.columns, board.rows));
    }
    EXPECT_TRUE(find_corners(image.view(), board));
    EXPECT_TRUE(
        find_corners(image.view(), {board.rows, board.columns, 0.024}));  // rows and columns exchanged
  }
  EXPECT_FALSE(board_in(Image(320, 240).view(), kDrawnBoard));
  EXPECT_FALSE(board_in(Image(1, 1).view(), kDrawnBoard));
}

TEST(StereoCalibration, RefusesWhatTellsNothing) {
  const StereoRig is = known_head(640, 480);
  const std::vector<PairCorners> good = exact_pairs(is, 6);
  EXPECT_THAT(refusal({good.begin(), good.begin() + 3}), HasSubstr("found in 3 pairs; expected at least 4"));
  std::vector<PairCorners> parallel;
  for (int i = 0; i < 6; ++i)
    parallel.push_back(projected(is, kDrawnBoard,
                                 Pose<'C', 'O'>(rotation_xyz(Vec3(0.2, 0.1, 0.1 * i)),
                                                Vec3(-0.08 + 0.02 * i, -0.05, 0.45 + 0.03 * i))));
  EXPECT_THAT(refusal(parallel), HasSubstr("stand parallel"));
  std::vector<PairCorners> exchanged = good;
  for (PairCorners& pair : exchanged) std::swap(pair.left, pair.right);
  EXPECT_THAT(refusal(exchanged), HasSubstr("exchanged"));
  StereoRig below = is;
  below.X_CD = Pose<'C', 'D'>(is.X_CD.q(), Vec3(0.0, 0.09, 0.0));
  EXPECT_THAT(refusal(exact_pairs(below, 6)), HasSubstr("stands below the first"));
}

// The rays of exact corners meet at the corner.
TEST(StereoCalibration, TriangulatesInMetres) {
  const StereoRig is = known_head(640, 480);
  const Pose<'C', 'O'> X_CO = tilted_boards(kDrawnBoard, 2)[1];
  const std::vector<Point<'C'>> places = triangulated(is, projected(is, kDrawnBoard, X_CO));
  EXPECT_LT((places[0] - X_CO.origin()).norm(), 1e-8);
  EXPECT_LT((places[9] - X_CO * Point<'O'>(0.0, 0.024, 0.0)).norm(), 1e-8);
}

TEST(StereoCalibration, TheSamePairsGiveTheSameBits) {
  const std::vector<PairCorners> pairs = exact_pairs(known_head(640, 480), 5);
  const StereoCalibration a = calibrate_stereo(pairs, kDrawnBoard, 640, 480);
  const StereoCalibration b = calibrate_stereo(pairs, kDrawnBoard, 640, 480);
  EXPECT_EQ(a.rig.X_CD.xyz, b.rig.X_CD.xyz);
  EXPECT_EQ(a.rig.X_CD.xyzw, b.rig.X_CD.xyzw);
  EXPECT_EQ(a.rig.left.distortion, b.rig.left.distortion);
}

// The 13 real pairs of chessboards of Debian's opencv-doc (./check fetches them into .deps/chessboards): the
// whole way from files to a head, judged by pairs outside the calibration.

const std::string kFolder = tests::source_dir() + "/.deps/chessboards";
const Board kBoard{9, 6, 0.025};  // the sheet's squares have no known size; this one is for the report

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
  EXPECT_EQ(found.k3, K3::zero);  // k3 of the right lens is 2.5 deviations from 0
  EXPECT_LE(found.rms, 0.6);
  EXPECT_LE(found.epipolar, 0.6);
  EXPECT_LE(found.rows, 0.6);
}

// The error message states the number of corners on the sheet if the user counts squares or misses a row. No
// part of the sheet passes for it.
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

// The epipolar error belongs to the head and not to the image: a head that is turned by half a degree has 4.6
// px.
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
