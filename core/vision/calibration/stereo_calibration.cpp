#include "core/vision/calibration/stereo_calibration.h"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>

#include "core/error.h"
#include "core/vision/calibration/opencv_types.h"
#include "core/vision/calibration/rectify.h"

namespace enc {
namespace {

using calibration::Extrinsics;
using calibration::points_of;
using Views = std::vector<std::vector<cv::Point2f>>;

constexpr double kDegree = M_PI / 180.0;
// k3 bends the corner of an image alone and is not to be had from a board that seldom stands there.
constexpr int kModel = cv::CALIB_FIX_K3;
const cv::TermCriteria kUntil(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-9);

struct Camera {
  cv::Mat matrix = cv::Mat::eye(3, 3, CV_64F), distortion = cv::Mat::zeros(1, 5, CV_64F);
  double focal_deviation = kUnset;  // a share of the focal length
};
struct Head {
  Camera left, right;
  Extrinsics pose;
  cv::Mat per_view;  // px rms, a row for each pair
  double rms = kUnset;
};

std::vector<cv::Point3f> board_points(const Board& board) {
  std::vector<cv::Point3f> points;
  const auto side = static_cast<float>(board.square);
  for (int r = 0; r < board.rows; ++r)
    for (int c = 0; c < board.columns; ++c)
      points.emplace_back(static_cast<float>(c) * side, static_cast<float>(r) * side, 0.0F);
  return points;
}

Camera one_camera(const std::vector<std::vector<cv::Point3f>>& boards, const Views& views,
                  const cv::Size& size) {
  Camera camera;
  std::vector<cv::Mat> turns, places;
  cv::Mat deviation, none, errors;
  cv::calibrateCamera(boards, views, size, camera.matrix, camera.distortion, turns, places, deviation, none,
                      errors, kModel, kUntil);
  camera.focal_deviation = std::max(deviation.at<double>(0) / camera.matrix.at<double>(0, 0),
                                    deviation.at<double>(1) / camera.matrix.at<double>(1, 1));
  return camera;
}

// Each by itself, then all numbers of both together, so that they agree on where the boards were.
Head solve(const std::vector<PairCorners>& pairs, const Board& board, const cv::Size& size) {
  Views left, right;
  for (const PairCorners& pair : pairs) {
    left.push_back(points_of(pair.left));
    right.push_back(points_of(pair.right));
  }
  const std::vector<std::vector<cv::Point3f>> boards(pairs.size(), board_points(board));
  Head head{one_camera(boards, left, size), one_camera(boards, right, size), {}, {}, kUnset};
  cv::Mat essential, fundamental;
  head.rms =
      cv::stereoCalibrate(boards, left, right, head.left.matrix, head.left.distortion, head.right.matrix,
                          head.right.distortion, size, head.pose.R, head.pose.T, essential, fundamental,
                          head.per_view, kModel | cv::CALIB_USE_INTRINSIC_GUESS, kUntil);
  return head;
}

StereoRig rig_of(const Head& head, const cv::Size& size) {
  StereoRig rig;
  rig.width = size.width;
  rig.height = size.height;
  rig.left = calibration::lens_of(head.left.matrix, head.left.distortion);
  rig.right = calibration::lens_of(head.right.matrix, head.right.distortion);
  rig.X_CD = calibration::pose_of(head.pose);
  return rig;
}

// Of the board's plane in the camera, out of one image: the line at which the plane's horizon is seen.
Vec3 normal_of(const Corners& corners, const Board& board, const Lens& lens) {
  std::vector<cv::Point2f> plane;
  for (const cv::Point3f& p : board_points(board)) plane.emplace_back(p.x, p.y);
  const cv::Mat homography = cv::findHomography(plane, points_of(corners));
  if (homography.empty()) return Vec3::UnitZ();
  const cv::Mat horizon = homography.inv().t() * (cv::Mat_<double>(3, 1) << 0, 0, 1);
  const cv::Mat normal = calibration::camera_matrix(lens).t() * horizon;
  return Vec3(normal.at<double>(0), normal.at<double>(1), normal.at<double>(2)).normalized();
}

double largest_tilt(const std::vector<PairCorners>& pairs, const Board& board, const Lens& lens) {
  std::vector<Vec3> normals;
  normals.reserve(pairs.size());
  for (const PairCorners& pair : pairs) normals.push_back(normal_of(pair.left, board, lens));
  double least = 1.0;
  for (const Vec3& a : normals)
    for (const Vec3& b : normals) least = std::min(least, std::abs(a.dot(b)));
  return std::acos(std::min(1.0, least));
}

void refuse_parallel(const std::vector<PairCorners>& pairs, const Board& board, const cv::Size& size) {
  constexpr double kLeast = 5.0 * kDegree;
  const double focal = std::max(size.width, size.height);  // near enough for an angle
  const Lens any{focal, focal, 0.5 * (size.width - 1), 0.5 * (size.height - 1), {}};
  if (largest_tilt(pairs, board, any) < kLeast)
    throw Error(
        "all boards stand parallel, which tells nothing of the focal length; expected boards that are tilted "
        "by 20 to 45 degrees to all sides; take more pairs");
}

// What no optimum of a stereo head looks like.
void check_head(const StereoCalibration& found) {
  constexpr double kLoosest = 0.05;  // of the focal length
  const auto refuse = [](const std::string& what) {
    throw Error(what +
                "; expected pairs of one head with the board near, tilted and in all corners; take more");
  };
  if (!(found.focal_deviation < kLoosest)) refuse("the pairs do not tell the focal length");
  const Vec3 shift = found.rig.X_CD.p();
  if (!found.rig.X_CD.valid() || !(shift.x() > 0.0) || shift.x() < shift.tail<2>().norm())
    refuse("the second camera does not stand to the right of the first (are left and right exchanged?)");
}

double square_of(const StereoRig& rig, const PairCorners& pair, const Board& board) {
  const std::vector<Point<'C'>> places = triangulated(rig, pair);
  double sum = 0.0;
  int sides = 0;
  for (int r = 0; r < board.rows; ++r)
    for (int c = 0; c < board.columns; ++c) {
      const auto at = static_cast<std::size_t>(r * board.columns + c);
      if (c > 0) sum += (places[at] - places[at - 1]).norm(), ++sides;
      if (r > 0) sum += (places[at] - places[at - static_cast<std::size_t>(board.columns)]).norm(), ++sides;
    }
  return sum / sides;
}

double rms_over(const std::vector<PairResidual>& pairs, double PairResidual::*what) {
  double sum = 0.0;
  for (const PairResidual& p : pairs) sum += p.*what * p.*what;
  return std::sqrt(sum / static_cast<double>(pairs.size()));
}

}  // namespace

PairResidual residual_of(const StereoRig& rig, const PairCorners& pair, const Board& board) {
  return {kUnset, kUnset, epipolar_error(rig, pair), row_error(rig, pair), square_of(rig, pair, board),
          kUnset};
}

StereoCalibration calibrate_stereo(const std::vector<PairCorners>& pairs, const Board& board, int width,
                                   int height) {
  if (pairs.size() < kFewestBoards)
    throw Error("the board was found in " + std::to_string(pairs.size()) + " pairs; expected at least " +
                std::to_string(kFewestBoards) + "; take more");
  const cv::Size size(width, height);
  refuse_parallel(pairs, board, size);
  const Head head = solve(pairs, board, size);
  StereoCalibration found;
  found.rig = rig_of(head, size);
  found.rms = head.rms;
  found.focal_deviation = std::max(head.left.focal_deviation, head.right.focal_deviation);
  found.tilt = largest_tilt(pairs, board, found.rig.left);
  if (found.rms <= kLargestRms) check_head(found);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    std::vector<PairCorners> others = pairs;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const Head without = solve(others, board, size);
    PairResidual residual = residual_of(rig_of(without, size), pairs[i], board);
    residual.rms = without.rms;
    residual.left = head.per_view.at<double>(static_cast<int>(i), 0);
    residual.right = head.per_view.at<double>(static_cast<int>(i), 1);
    found.pairs.push_back(residual);
  }
  found.epipolar = rms_over(found.pairs, &PairResidual::epipolar);
  found.rows = rms_over(found.pairs, &PairResidual::rows);
  return found;
}

}  // namespace enc
