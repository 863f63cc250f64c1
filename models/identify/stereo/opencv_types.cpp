#include "models/identify/stereo/opencv_types.h"

namespace enc::calibration {

std::vector<cv::Point2f> points_of(const Corners& corners) {
  std::vector<cv::Point2f> points;
  points.reserve(corners.size());
  for (const Eigen::Vector2d& c : corners)
    points.emplace_back(static_cast<float>(c.x()), static_cast<float>(c.y()));
  return points;
}

cv::Mat camera_matrix(const Lens& lens) {
  cv::Mat camera = cv::Mat::eye(3, 3, CV_64F);
  camera.at<double>(0, 0) = lens.focal_x;
  camera.at<double>(1, 1) = lens.focal_y;
  camera.at<double>(0, 2) = lens.centre_x;
  camera.at<double>(1, 2) = lens.centre_y;
  return camera;
}

cv::Mat distortion_of(const Lens& lens) {
  cv::Mat distortion(1, static_cast<int>(lens.distortion.size()), CV_64F);
  for (std::size_t i = 0; i < lens.distortion.size(); ++i)
    distortion.at<double>(static_cast<int>(i)) = lens.distortion[i];
  return distortion;
}

Lens lens_of(const cv::Mat& camera, const cv::Mat& distortion) {
  Lens lens{
      camera.at<double>(0, 0), camera.at<double>(1, 1), camera.at<double>(0, 2), camera.at<double>(1, 2), {}};
  for (std::size_t i = 0; i < lens.distortion.size(); ++i)
    lens.distortion[i] = distortion.at<double>(static_cast<int>(i));
  return lens;
}

Extrinsics extrinsics_of(const StereoRig& rig) {
  const Pose<'D', 'C'> X_DC = rig.X_CD.inverse();
  const Mat3 rotation = X_DC.q().toRotationMatrix();
  Extrinsics out{cv::Mat(3, 3, CV_64F), cv::Mat(3, 1, CV_64F)};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) out.R.at<double>(r, c) = rotation(r, c);
    out.T.at<double>(r) = X_DC.p()(r);
  }
  return out;
}

Pose<'C', 'D'> pose_of(const Extrinsics& extrinsics) {
  Mat3 rotation;
  Vec3 shift;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) rotation(r, c) = extrinsics.R.at<double>(r, c);
    shift(r) = extrinsics.T.at<double>(r);
  }
  return Pose<'D', 'C'>(Quat(rotation).normalized(), shift).inverse();
}

}  // namespace enc::calibration
