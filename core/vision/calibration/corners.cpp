#include "core/vision/calibration/corners.h"

#include <algorithm>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace enc {
namespace {

cv::Mat grey_of(const ImageView& image) {
  // OpenCV knows no read-only matrix; nothing is written.
  const cv::Mat colour(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb));
  cv::Mat grey;
  cv::cvtColor(colour, grey, cv::COLOR_RGB2GRAY);
  return grey;
}

// As it is, then twice as large, where squares of a few pixels are found, too.
bool find(const cv::Mat& grey, const cv::Size& size, std::vector<cv::Point2f>& points) {
  constexpr int kFlags = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE;
  if (cv::findChessboardCorners(grey, size, points, kFlags)) return true;
  cv::Mat large;
  cv::resize(grey, large, {}, 2.0, 2.0, cv::INTER_LINEAR_EXACT);
  if (!cv::findChessboardCorners(large, size, points, kFlags)) return false;
  for (cv::Point2f& p : points) p = (p - cv::Point2f(0.5F, 0.5F)) * 0.5F;
  return true;
}

// Half of the window in which a corner is refined. Its diagonal must not reach the board's edge, which may be
// half a square away, and never the next corner.
int half_window(const std::vector<cv::Point2f>& points, const Board& board, int row, int column) {
  const auto at = [&](int r, int c) { return points[static_cast<std::size_t>(r * board.columns + c)]; };
  double nearest = 1e9;
  for (const auto& [r, c] :
       {std::pair{row, column - 1}, {row, column + 1}, {row - 1, column}, {row + 1, column}})
    if (r >= 0 && r < board.rows && c >= 0 && c < board.columns)
      nearest = std::min(nearest, cv::norm(at(row, column) - at(r, c)));
  return std::clamp(static_cast<int>(0.3 * nearest), 2, 11);
}

Corners refined(const cv::Mat& grey, const std::vector<cv::Point2f>& points, const Board& board) {
  Corners corners;
  corners.reserve(points.size());
  std::vector<cv::Point2f> one(1);
  for (int r = 0; r < board.rows; ++r)
    for (int c = 0; c < board.columns; ++c) {
      one[0] = points[corners.size()];
      const int half = half_window(points, board, r, c);
      cv::cornerSubPix(grey, one, {half, half}, {-1, -1},
                       {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-3});
      corners.emplace_back(one[0].x, one[0].y);
    }
  return corners;
}

}  // namespace

std::optional<Corners> find_corners(const ImageView& image, const Board& board) {
  constexpr int kSmallest = 16;  // px: OpenCV's finder wants some room
  if (image.width < kSmallest || image.height < kSmallest) return {};
  const cv::Mat grey = grey_of(image);
  std::vector<cv::Point2f> points;
  if (!find(grey, {board.columns, board.rows}, points) || points.size() != board.corners()) return {};
  return refined(grey, points, board);
}

PairCorners in_one_order(Corners left, Corners right) {
  const Eigen::Vector2d along_left = left.back() - left.front();
  const Eigen::Vector2d along_right = right.back() - right.front();
  if (along_left.dot(along_right) < 0.0) std::reverse(right.begin(), right.end());
  return {std::move(left), std::move(right)};
}

}  // namespace enc
