#include "models/identify/stereo/stereo_calibration.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/vision/stereo/rectify.h"
#include "models/identify/stereo/lens_solver.h"

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

// Solves all numbers of both cameras together, starting from each camera alone, so that they agree on the
// boards' poses.
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

// The normal of the board's plane in the camera, from one image: from the line of its horizon.
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
  const double focal = std::max(size.width, size.height);  // accurate enough for an angle
  const Lens any{focal, focal, 0.5 * (size.width - 1), 0.5 * (size.height - 1), {}};
  if (largest_tilt(pairs, board, any) < kLeast)
    throw Error(
        "all boards stand parallel, which tells nothing of the focal length; expected boards that are tilted "
        "by 20 to 45 degrees to all sides; take more pairs");
}

// Refuses a result that cannot belong to the optics of a stereo head.
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

// Square size of the best-fitting board of that shape [Umeyama 1991]; a mean over distances of neighbours
// would grow with noise.
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
  return (singular.at<double>(0) + singular.at<double>(1)) / squares;  // the board is flat, so the third is 0
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
  constexpr int kSteps = 30;  // steps from the full solution to one without a pair
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

namespace {

using calibration::camera_matrix;
using calibration::distortion_of;

struct Rectification {
  std::array<cv::Mat, 2> turn, projection;
};

// Rectification as for cameras without distortion: a lens's distortion must not change the scale at which
// rows are compared.
Rectification rectification_of(const StereoRig& rig) {
  constexpr double kAsLarge = -1.0;
  const calibration::Extrinsics pose = calibration::extrinsics_of(rig);
  Rectification out;
  cv::Mat depth;
  const cv::Size size(static_cast<int>(rig.width), static_cast<int>(rig.height));
  cv::stereoRectify(camera_matrix(rig.left), {}, camera_matrix(rig.right), {}, size, pose.R, pose.T,
                    out.turn[0], out.turn[1], out.projection[0], out.projection[1], depth,
                    cv::CALIB_ZERO_DISPARITY, kAsLarge);
  return out;
}

const Lens& lens_of(const StereoRig& rig, std::size_t side) { return side == 0 ? rig.left : rig.right; }
const Corners& corners_of(const PairCorners& pair, std::size_t side) {
  return side == 0 ? pair.left : pair.right;
}

// Rays of corners, as intersections with z = 1 of the camera. OpenCV's own search diverges for strong
// distortion.
std::vector<Vec3> rays_of(const Lens& lens, const Corners& corners) {
  std::vector<Vec3> rays;
  rays.reserve(corners.size());
  for (const Eigen::Vector2d& c : corners) {
    const Ray ray = ray_of(lens, {c.x(), c.y()});
    rays.emplace_back(ray.x, ray.y, 1.0);
  }
  return rays;
}
// Their positions in the rectified image, px.
std::vector<cv::Point2d> rectified(const StereoRig& rig, const PairCorners& pair, std::size_t side,
                                   const Rectification& by) {
  std::vector<cv::Point2d> points;
  const cv::Mat_<double> to = by.projection[side].colRange(0, 3) * by.turn[side];
  for (const Vec3& ray : rays_of(lens_of(rig, side), corners_of(pair, side))) {
    const cv::Mat_<double> at = to * (cv::Mat_<double>(3, 1) << ray.x(), ray.y(), ray.z());
    points.emplace_back(at(0) / at(2), at(1) / at(2));
  }
  return points;
}

Mat3 matrix_of(const Lens& lens) {
  Mat3 matrix;
  matrix << lens.focal_x, 0, lens.centre_x, 0, lens.focal_y, lens.centre_y, 0, 0, 1;
  return matrix;
}
double distance(const Vec3& point, const Vec3& line) { return point.dot(line) / line.head<2>().norm(); }

}  // namespace

double epipolar_error(const StereoRig& rig, const PairCorners& pair) {
  const Pose<'D', 'C'> X_DC = rig.X_CD.inverse();
  const Vec3 t = X_DC.p();
  Mat3 cross;
  cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  const Mat3 essential = cross * X_DC.q().toRotationMatrix();  // x_D' E x_C = 0
  const Mat3 left = matrix_of(rig.left), right = matrix_of(rig.right);
  const std::vector<Vec3> in_left = rays_of(rig.left, pair.left), in_right = rays_of(rig.right, pair.right);
  double sum = 0.0;
  for (std::size_t i = 0; i < in_left.size(); ++i) {
    const Vec3 &c = in_left[i], &d = in_right[i];
    const Vec3 line_right = right.inverse().transpose() * (essential * c);
    const Vec3 line_left = left.inverse().transpose() * (essential.transpose() * d);
    const double a = distance(right * d, line_right), b = distance(left * c, line_left);
    sum += a * a + b * b;
  }
  return std::sqrt(sum / (2.0 * static_cast<double>(in_left.size())));
}

double row_error(const StereoRig& rig, const PairCorners& pair) {
  const Rectification by = rectification_of(rig);
  const std::vector<cv::Point2d> left = rectified(rig, pair, 0, by), right = rectified(rig, pair, 1, by);
  double sum = 0.0;
  for (std::size_t i = 0; i < left.size(); ++i) sum += (left[i].y - right[i].y) * (left[i].y - right[i].y);
  return std::sqrt(sum / static_cast<double>(left.size()));
}

std::vector<Point<'C'>> triangulated(const StereoRig& rig, const PairCorners& pair) {
  const std::vector<Vec3> in_left = rays_of(rig.left, pair.left), in_right = rays_of(rig.right, pair.right);
  const Vec3 base = rig.X_CD.p();
  std::vector<Point<'C'>> places;
  places.reserve(in_left.size());
  for (std::size_t i = 0; i < in_left.size(); ++i) {
    // Closest points of s u and base + r v.
    const Vec3 u = in_left[i], v = rig.X_CD.q() * in_right[i];
    const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm();
    const double apart = uu * vv - uv * uv;
    const double s = (vv * u.dot(base) - uv * v.dot(base)) / apart;
    const double r = (uv * u.dot(base) - uu * v.dot(base)) / apart;
    places.emplace_back(Vec3(0.5 * (s * u + base + r * v)));
  }
  return places;
}

Image rectified_picture(const StereoRig& rig, const std::vector<ShownPair>& pairs) {
  constexpr int kLines = 12, kHead = 22;  // px of text above a pair
  const int width = static_cast<int>(rig.width), height = static_cast<int>(rig.height);
  const Rectification by = rectification_of(rig);
  Image picture(2 * width, static_cast<int>(pairs.size()) * (height + kHead));
  cv::Mat canvas(picture.height, picture.width, CV_8UC3, picture.rgb.data());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const ShownPair& pair = pairs[k];
    const int top = static_cast<int>(k) * (height + kHead) + kHead;
    cv::putText(canvas, pair.words, {8, top - 6}, cv::FONT_HERSHEY_SIMPLEX, 0.45, {255, 255, 255}, 1,
                cv::LINE_AA);
    for (std::size_t side = 0; side < 2; ++side) {
      const ImageView& from = side == 0 ? pair.left : pair.right;
      const cv::Mat image(from.height, from.width, CV_8UC3, const_cast<std::uint8_t*>(from.rgb));
      cv::Mat columns, rows;
      cv::initUndistortRectifyMap(camera_matrix(lens_of(rig, side)), distortion_of(lens_of(rig, side)),
                                  by.turn[side], by.projection[side], {width, height}, CV_32FC1, columns,
                                  rows);
      const cv::Rect place(static_cast<int>(side) * width, top, width, height);
      cv::Mat part = canvas(place);
      cv::remap(image, part, columns, rows, cv::INTER_LINEAR);
      for (const cv::Point2d& p : rectified(rig, pair.corners, side, by))
        cv::circle(part, p, 3, {255, 40, 40}, 1, cv::LINE_AA);
    }
    for (int line = 1; line < kLines; ++line) {
      const int y = top + line * height / kLines;
      cv::line(canvas, {0, y}, {2 * width - 1, y}, {60, 220, 60}, 1);
    }
  }
  return picture;
}

}  // namespace enc
