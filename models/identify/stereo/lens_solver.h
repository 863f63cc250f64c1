// The lenses of two cameras, each out of its own views of a board [Zhang 2000]. For sources of this folder
// only.
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "models/identify/stereo/stereo_calibration.h"

namespace enc::calibration {

using Views = std::vector<std::vector<cv::Point2f>>;  // px, the corners of a board in each image

inline constexpr int kMostSteps = 100;
[[nodiscard]] inline cv::TermCriteria until(int steps) {
  return {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, steps, 1e-9};
}

struct Camera {
  cv::Mat matrix = cv::Mat::eye(3, 3, CV_64F), distortion = cv::Mat::zeros(1, 5, CV_64F);
  double focal_deviation = kUnset;  // a share of the focal length
  double k3_in_deviations = 0.0;
  LensFit fit;

  // A matrix of OpenCV shares its numbers with its copies.
  [[nodiscard]] Camera copy() const;
};
struct Cameras {
  Camera left, right;
  K3 k3 = K3::zero;

  // OpenCV's flags: which numbers of the lenses stay as they are.
  [[nodiscard]] int model() const;
};
// m, in the order of its corners.
[[nodiscard]] std::vector<cv::Point3f> board_points(const Board& board);

// Both lenses have a k3, or none.
[[nodiscard]] Cameras each_camera(const Views& left, const Views& right, const Board& board,
                                  const cv::Size& size);

}  // namespace enc::calibration
