#include "models/identify/stereo/rectify.h"

#include <array>
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "core/vision/stereo/lens.h"
#include "models/identify/stereo/opencv_types.h"

namespace enc {
namespace {

using calibration::camera_matrix;
using calibration::distortion_of;

struct Rectification {
  std::array<cv::Mat, 2> turn, projection;
};

// Of cameras without distortion: how a lens bends must not change the size in which rows are compared.
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

// Rays of corners, by where they meet z = 1 of the camera. OpenCV's own search runs away from a lens that
// bends much.
std::vector<Vec3> rays_of(const Lens& lens, const Corners& corners) {
  std::vector<Vec3> rays;
  rays.reserve(corners.size());
  for (const Eigen::Vector2d& c : corners) {
    const Ray ray = ray_of(lens, {c.x(), c.y()});
    rays.emplace_back(ray.x, ray.y, 1.0);
  }
  return rays;
}
// Where they are in the rectified image, px.
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
    // Nearest points of s u and base + r v.
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
  constexpr int kLines = 12, kHead = 22;  // px of words over a pair
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
