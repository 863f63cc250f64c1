// The lenses of two cameras, each from its own views of a board [Zhang 2000]. Only for sources of this
// folder.
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "core/spec/optics_rig.h"
#include "models/identify/stereo/corners.h"
#include "models/identify/stereo/stereo_calibration.h"

namespace enc::calibration {

// Conversions between our types and OpenCV's. Only for sources of this folder.
[[nodiscard]] std::vector<cv::Point2f> points_of(const Corners& corners);
[[nodiscard]] cv::Mat camera_matrix(const Lens& lens);  // 3 x 3
[[nodiscard]] cv::Mat distortion_of(const Lens& lens);  // 1 x 5
[[nodiscard]] Lens lens_of(const cv::Mat& camera, const cv::Mat& distortion);
// OpenCV's pose of the left camera in the right one, x_D = R x_C + T.
struct Extrinsics {
  cv::Mat R, T;
};
[[nodiscard]] Extrinsics extrinsics_of(const StereoRig& rig);
[[nodiscard]] Pose<'C', 'D'> pose_of(const Extrinsics& extrinsics);

using Views = std::vector<std::vector<cv::Point2f>>;  // px, the corners of a board in each image

inline constexpr int kMostSteps = 100;
[[nodiscard]] inline cv::TermCriteria until(int steps) {
  return {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, steps, 1e-9};
}

struct Camera {
  cv::Mat matrix = cv::Mat::eye(3, 3, CV_64F), distortion = cv::Mat::zeros(1, 5, CV_64F);
  double focal_deviation = kUnset;  // share of the focal length
  double k3_in_deviations = 0.0;
  LensFit fit;

  // Deep copy: an OpenCV matrix shares its numbers with its copies.
  [[nodiscard]] Camera copy() const;
};
struct Cameras {
  Camera left, right;
  K3 k3 = K3::zero;

  // OpenCV's flags: the lens parameters that stay fixed.
  [[nodiscard]] int model() const;
};
// m, in the order of the board's corners.
[[nodiscard]] std::vector<cv::Point3f> board_points(const Board& board);

// Either both lenses have a k3 or neither.
[[nodiscard]] Cameras each_camera(const Views& left, const Views& right, const Board& board,
                                  const cv::Size& size);

}  // namespace enc::calibration
