// Conversions between our types and OpenCV's. Only for sources of this folder.
#pragma once

#include <opencv2/core.hpp>

#include "core/spec/vision/stereo_rig.h"
#include "models/identify/stereo/corners.h"

namespace enc::calibration {

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

}  // namespace enc::calibration
