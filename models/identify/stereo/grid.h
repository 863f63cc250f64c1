// A grid of corners in an image that may be part of a larger chessboard. Only for sources of this folder.
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

// Moves the corners to their exact positions in the image, to a fraction of a pixel.
void refine(const cv::Mat& grey, Grid& grid);

// True if the squares between the corners alternate between black and white.
[[nodiscard]] bool alternates(const cv::Mat& grey, const Grid& grid);

// Beyond a side, the board goes on if the squares alternate there; it ends if margin or background begins;
// the answer is open if the image ends before.
enum class Beyond : std::uint8_t { ends, goes_on, open };
// Beyond the last column. The grid must have at least three columns and rows.
[[nodiscard]] Beyond beyond(const cv::Mat& grey, const Grid& grid);
// A quarter turn: the last column becomes the first row.
[[nodiscard]] Grid turned(const Grid& grid);
}  // namespace enc::calibration
