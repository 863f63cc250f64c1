#include "models/identify/stereo/lens_solver.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/calib3d.hpp>

#include "core/vision/stereo/rectify.h"

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

namespace {

// True if a pixel in each corner of the image has a ray.
bool spreads(const Camera& camera, const cv::Size& size) {
  const Lens lens = lens_of(camera.matrix, camera.distortion);
  const double right = size.width - 1, low = size.height - 1;
  const std::array<Pixel, 4> corners{{{0, 0}, {right, 0}, {0, low}, {right, low}}};
  return std::all_of(corners.begin(), corners.end(),
                     [&](const Pixel& corner) { return std::isfinite(ray_of(lens, corner).x); });
}

// The fit of a camera's lens to all its views.
class LensSolver {
 public:
  LensSolver(const Views& views, const Board& board, const cv::Size& size)
      : views_(views), boards_(views.size(), board_points(board)), size_(size) {}

  // Starts from the values in `camera`.
  void solve(Camera& camera, int model) {
    cv::Mat deviation, none, errors;
    camera.fit.rms = cv::calibrateCamera(boards_, views_, size_, camera.matrix, camera.distortion, turns_,
                                         places_, deviation, none, errors, model, until(kMostSteps));
    camera.focal_deviation = std::max(deviation.at<double>(0) / camera.matrix.at<double>(0, 0),
                                      deviation.at<double>(1) / camera.matrix.at<double>(1, 1));
    const double k3 = deviation.at<double>(8);
    camera.k3_in_deviations = k3 > 0.0 ? std::abs(camera.distortion.at<double>(4)) / k3 : 0.0;
  }

  // Evaluates the last solution.
  void judge(Camera& camera) const {
    constexpr std::size_t kRings = 8;
    const cv::Point2d axis(camera.matrix.at<double>(0, 2), camera.matrix.at<double>(1, 2));
    const double farthest = cv::norm(cv::Point2d(std::max(axis.x, size_.width - 1.0 - axis.x),
                                                 std::max(axis.y, size_.height - 1.0 - axis.y)));
    std::vector<std::pair<double, double>> corners = off_axis(camera, axis);
    std::sort(corners.begin(), corners.end());
    camera.fit.reach = corners.back().first / farthest;
    camera.fit.outwards = 0.0;
    for (std::size_t ring = 0; ring < kRings; ++ring) {
      const std::size_t begin = ring * corners.size() / kRings, end = (ring + 1) * corners.size() / kRings;
      double sum = 0.0, squares = 0.0;
      for (std::size_t i = begin; i < end; ++i)
        sum += corners[i].second, squares += corners[i].second * corners[i].second;
      const auto count = static_cast<double>(end - begin);
      const double mean = sum / count;
      if (ring > 0 && std::abs(mean) <= std::abs(camera.fit.outwards)) continue;
      camera.fit.outwards = mean;
      camera.fit.outwards_deviation = std::sqrt(std::max(0.0, squares / count - mean * mean) / count);
      camera.fit.ring = corners[(begin + end) / 2].first / farthest;
    }
  }

 private:
  // Each corner's distance from the axis, px, and the extra distance beyond the lens model.
  [[nodiscard]] std::vector<std::pair<double, double>> off_axis(const Camera& camera,
                                                                const cv::Point2d& axis) const {
    std::vector<std::pair<double, double>> out;
    std::vector<cv::Point2f> points;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      cv::projectPoints(boards_[i], turns_[i], places_[i], camera.matrix, camera.distortion, points);
      for (std::size_t k = 0; k < points.size(); ++k) {
        const cv::Point2d from(cv::Point2d(points[k]) - axis), off(views_[i][k] - points[k]);
        const double distance = cv::norm(from);
        if (distance > 1.0) out.emplace_back(distance, off.dot(from) / distance);
      }
    }
    return out;
  }

  const Views& views_;
  std::vector<std::vector<cv::Point3f>> boards_;
  cv::Size size_;
  std::vector<cv::Mat> turns_, places_;
};

}  // namespace

Camera Camera::copy() const {
  Camera copy = *this;
  copy.matrix = matrix.clone();
  copy.distortion = distortion.clone();
  return copy;
}

int Cameras::model() const { return k3 == K3::fitted ? 0 : cv::CALIB_FIX_K3; }

std::vector<cv::Point3f> board_points(const Board& board) {
  std::vector<cv::Point3f> points;
  const auto side = static_cast<float>(board.square);
  for (int r = 0; r < board.rows; ++r)
    for (int c = 0; c < board.columns; ++c)
      points.emplace_back(static_cast<float>(c) * side, static_cast<float>(r) * side, 0.0F);
  return points;
}

// Solves in steps, each starting from the last result: a search for everything at once may end far from the
// solution.
Cameras each_camera(const Views& left, const Views& right, const Board& board, const cv::Size& size) {
  constexpr double kTold = 3.0;
  constexpr int kPinhole =
      cv::CALIB_FIX_K1 | cv::CALIB_FIX_K2 | cv::CALIB_FIX_K3 | cv::CALIB_ZERO_TANGENT_DIST;
  constexpr int kGuess = cv::CALIB_USE_INTRINSIC_GUESS;
  LensSolver of_left(left, board, size), of_right(right, board, size);
  Cameras usual;
  for (const auto& [solver, camera] : {std::pair{&of_left, &usual.left}, {&of_right, &usual.right}}) {
    solver->solve(*camera, kPinhole);
    solver->solve(*camera, usual.model() | kGuess);
    solver->judge(*camera);
  }
  Cameras bent{usual.left.copy(), usual.right.copy(), K3::fitted};
  for (const auto& [solver, camera] : {std::pair{&of_left, &bent.left}, {&of_right, &bent.right}}) {
    solver->solve(*camera, bent.model() | kGuess);
    solver->judge(*camera);
  }
  if (std::max(bent.left.k3_in_deviations, bent.right.k3_in_deviations) <= kTold) return usual;
  if (spreads(bent.left, size) && spreads(bent.right, size)) return bent;
  usual.k3 = K3::folds;
  return usual;
}

}  // namespace enc::calibration
