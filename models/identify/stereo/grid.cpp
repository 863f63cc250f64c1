#include "models/identify/stereo/grid.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace enc::calibration {
namespace {

// Half of the window in which a corner is refined. Its diagonal must not reach the board's edge, which may be
// half a square away, and never the next corner.
int half_window(const Grid& grid, int row, int column) {
  double nearest = 1e9;
  for (const auto& [r, c] :
       {std::pair{row, column - 1}, {row, column + 1}, {row - 1, column}, {row + 1, column}})
    if (r >= 0 && r < grid.rows && c >= 0 && c < grid.columns)
      nearest = std::min(nearest, cv::norm(grid.at(row, column) - grid.at(r, c)));
  return std::clamp(static_cast<int>(0.3 * nearest), 2, 11);
}

// Mean over 3 x 3 pixels.
double brightness(const cv::Mat& grey, const cv::Point2f& p) {
  const int x = static_cast<int>(std::lround(p.x)), y = static_cast<int>(std::lround(p.y));
  int sum = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) sum += grey.at<std::uint8_t>(y + dy, x + dx);
  return sum / 9.0;
}
bool inside(const cv::Mat& grey, const cv::Point2f& p) {
  return p.x >= 1.5F && p.y >= 1.5F && p.x < static_cast<float>(grey.cols) - 2.5F &&
         p.y < static_cast<float>(grey.rows) - 2.5F;
}

// Where the next corner of a row would be, by the last three.
cv::Point2f next_of(const Grid& grid, int row) {
  const int c = grid.columns - 1;
  return 3.0F * grid.at(row, c) - 3.0F * grid.at(row, c - 1) + grid.at(row, c - 2);
}

}  // namespace

void refine(const cv::Mat& grey, Grid& grid) {
  const Grid rough = grid;
  std::vector<cv::Point2f> one(1);
  for (int r = 0; r < grid.rows; ++r)
    for (int c = 0; c < grid.columns; ++c) {
      one[0] = rough.at(r, c);
      const int half = half_window(rough, r, c);
      cv::cornerSubPix(grey, one, {half, half}, {-1, -1},
                       {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-3});
      grid.points[static_cast<std::size_t>(r * grid.columns + c)] = one[0];
    }
}

bool alternates(const cv::Mat& grey, const Grid& grid) {
  constexpr double kLeast = 6.0;  // of 255, between neighbours
  constexpr double kMost = 0.9;   // share of neighbours: a finger may hide a few
  const auto middle = [&](int r, int c) {
    return 0.25F * (grid.at(r, c) + grid.at(r, c + 1) + grid.at(r + 1, c) + grid.at(r + 1, c + 1));
  };
  int brighter = 0, darker = 0, all = 0;
  for (int r = 0; r + 1 < grid.rows; ++r)
    for (int c = 0; c + 2 < grid.columns; ++c) {
      const cv::Point2f here = middle(r, c), next = middle(r, c + 1);
      ++all;
      if (!inside(grey, here) || !inside(grey, next)) continue;
      const double step = ((r + c) % 2 == 0 ? 1.0 : -1.0) * (brightness(grey, next) - brightness(grey, here));
      if (step > kLeast) ++brighter;
      if (step < -kLeast) ++darker;
    }
  return std::max(brighter, darker) >= kMost * all;
}

Beyond beyond(const cv::Mat& grey, const Grid& grid) {
  constexpr float kInto = 0.3F;       // of a square, from a corner into the four around it
  constexpr double kAlike = -0.5;     // of the contrast before the corner, against that behind it
  constexpr double kContrast = 12.0;  // of 255
  int seen = 0, alternate = 0;
  for (int r = 0; r < grid.rows; ++r) {
    const cv::Point2f corner = next_of(grid, r);
    const cv::Point2f out = kInto * (corner - grid.at(r, grid.columns - 1));
    const int above = std::max(0, r - 1), below = std::min(grid.rows - 1, r + 1);
    const cv::Point2f along = (kInto / static_cast<float>(below - above)) *
                              (grid.at(below, grid.columns - 1) - grid.at(above, grid.columns - 1));
    if (!inside(grey, corner + out + along) || !inside(grey, corner + out - along) ||
        !inside(grey, corner - out + along) || !inside(grey, corner - out - along))
      continue;
    ++seen;
    const double before = brightness(grey, corner - out + along) - brightness(grey, corner - out - along);
    const double behind = brightness(grey, corner + out + along) - brightness(grey, corner + out - along);
    if (std::abs(before) > kContrast && behind / before < kAlike) ++alternate;
  }
  if (2 * seen < grid.rows + 1) return Beyond::open;
  return 4 * alternate >= 3 * seen ? Beyond::goes_on : Beyond::ends;
}

Grid turned(const Grid& grid) {
  Grid out{grid.rows, grid.columns, {}};
  for (int r = 0; r < out.rows; ++r)
    for (int c = 0; c < out.columns; ++c) out.points.push_back(grid.at(c, grid.columns - 1 - r));
  return out;
}

}  // namespace enc::calibration
