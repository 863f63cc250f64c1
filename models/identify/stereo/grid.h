// A grid of corners in an image that may be part of a larger chessboard. For sources of this folder only.
#pragma once

#include <vector>

#include <opencv2/core.hpp>

namespace enc::calibration {

struct Grid {
  int columns = 0, rows = 0;
  std::vector<cv::Point2f> points;  // px, row by row

  [[nodiscard]] const cv::Point2f& at(int row, int column) const {
    return points[static_cast<std::size_t>(row * columns + column)];
  }
  [[nodiscard]] cv::Size size() const { return {columns, rows}; }
};

// Corners moved to where the image has them, to a fraction of a pixel.
void refine(const cv::Mat& grey, Grid& grid);

// Whether the squares between the corners are black and white by turns.
[[nodiscard]] bool alternates(const cv::Mat& grey, const Grid& grid);

// The board goes on beyond a side where the squares there alternate; it ends where margin or background
// begins; it is open where the image ends before.
enum class Beyond : std::uint8_t { ends, goes_on, open };
// Beyond the last column. The grid has three columns and rows at least.
[[nodiscard]] Beyond beyond(const cv::Mat& grey, const Grid& grid);
// A quarter of a turn: the last column becomes the first row.
[[nodiscard]] Grid turned(const Grid& grid);
}  // namespace enc::calibration
