#include "models/identify/stereo/stereo_calibration.h"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>

#include "core/base/error.h"
#include "core/base/units.h"
#include "models/identify/stereo/lens_solver.h"
#include "models/identify/stereo/opencv_types.h"
#include "models/identify/stereo/rectify.h"

namespace enc {
namespace {

using calibration::board_points;
using calibration::Cameras;
using calibration::Extrinsics;
using calibration::points_of;
using calibration::Views;

struct Head {
  calibration::Camera left, right;
  Extrinsics pose;
  cv::Mat per_view;  // px rms, a row for each pair
  double rms = kUnset;
};

std::pair<Views, Views> views_of(const std::vector<PairCorners>& pairs) {
  std::pair<Views, Views> views;
  for (const PairCorners& pair : pairs) {
    views.first.push_back(points_of(pair.left));
    views.second.push_back(points_of(pair.right));
  }
  return views;
}

// All numbers of both together, from those of each, so that they agree on where the boards were.
Head solve(const std::vector<PairCorners>& pairs, const Board& board, const cv::Size& size,
           const Cameras& cameras, int steps) {
  const auto [left, right] = views_of(pairs);
  const std::vector<std::vector<cv::Point3f>> boards(pairs.size(), board_points(board));
  Head head{cameras.left.copy(), cameras.right.copy(), {}, {}, kUnset};
  cv::Mat essential, fundamental;
  head.rms = cv::stereoCalibrate(boards, left, right, head.left.matrix, head.left.distortion,
                                 head.right.matrix, head.right.distortion, size, head.pose.R, head.pose.T,
                                 essential, fundamental, head.per_view,
                                 cameras.model() | cv::CALIB_USE_INTRINSIC_GUESS, calibration::until(steps));
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
  const auto refuse = [](const std::string& what) {
    throw Error(what +
                "; expected pairs of one head with the board near, tilted and in all corners; take more");
  };
  if (!(found.focal_deviation < kLoosestFocal)) refuse("the pairs do not tell the focal length");
  const Vec3 shift = found.rig.X_CD.p();
  if (!found.rig.X_CD.valid()) refuse("the pairs do not tell where the second camera stands");
  if (std::abs(shift.y()) > std::abs(shift.x()) && std::abs(shift.y()) > std::abs(shift.z()))
    refuse(std::string("the second camera stands ") + (shift.y() > 0.0 ? "below" : "above") +
           " the first (are the images turned by 90 degrees?)");
  if (!(shift.x() > 0.0) || shift.x() < shift.tail<2>().norm())
    refuse("the second camera does not stand to the right of the first (are left and right exchanged?)");
}

// By the board of the same shape that fits best [Umeyama 1991]: a mean over distances of neighbours grows
// with noise.
double square_of(const StereoRig& rig, const PairCorners& pair, const Board& board) {
  const std::vector<Point<'C'>> places = triangulated(rig, pair);
  Vec3 middle = Vec3::Zero(), board_middle(board.columns - 1, board.rows - 1, 0);
  board_middle *= 0.5;
  for (const Point<'C'>& p : places) middle += p.e() / static_cast<double>(places.size());
  Mat3 products = Mat3::Zero();
  double squares = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto at = static_cast<int>(i);
    const Vec3 on_board = Vec3(at % board.columns, at / board.columns, 0) - board_middle;
    products += (places[i].e() - middle) * on_board.transpose();
    squares += on_board.squaredNorm();
  }
  if (!products.allFinite()) return kUnset;
  cv::Mat singular;
  cv::SVD::compute(cv::Mat(3, 3, CV_64F, products.data()), singular, cv::SVD::NO_UV);
  return (singular.at<double>(0) + singular.at<double>(1)) / squares;  // the board is flat: the third is 0
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
  const auto [left, right] = views_of(pairs);
  const Cameras cameras = calibration::each_camera(left, right, board, size);
  const Head head = solve(pairs, board, size, cameras, calibration::kMostSteps);
  StereoCalibration found;
  found.rig = rig_of(head, size);
  found.left = cameras.left.fit;
  found.right = cameras.right.fit;
  found.k3 = cameras.k3;
  found.rms = head.rms;
  found.focal_deviation = std::max(head.left.focal_deviation, head.right.focal_deviation);
  found.tilt = largest_tilt(pairs, board, found.rig.left);
  if (found.rms <= kLargestRms && !found.left.unlike() && !found.right.unlike()) check_head(found);
  constexpr int kSteps = 30;  // from a solution to that of one pair less: where lenses fit, a few are enough
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    std::vector<PairCorners> others = pairs;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const Head without = solve(others, board, size, cameras, kSteps);
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
