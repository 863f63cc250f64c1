#include "models/identify/stereo/corners.h"

#include <algorithm>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "models/identify/stereo/grid.h"

namespace enc {
namespace {

using calibration::Beyond;
using calibration::Grid;

constexpr int kSmallest = 16;        // px: OpenCV's finders want some room
constexpr int kMostToDouble = 1600;  // px: what is larger has squares of more than a few
constexpr int kSectors = cv::CALIB_CB_EXHAUSTIVE | cv::CALIB_CB_NORMALIZE_IMAGE;

cv::Mat grey_of(const ImageView& image) {
  // OpenCV knows no read-only matrix; nothing is written.
  const cv::Mat colour(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb));
  cv::Mat grey;
  cv::cvtColor(colour, grey, cv::COLOR_RGB2GRAY);
  return grey;
}

using Finder = bool (*)(const cv::Mat& grey, const cv::Size& size, std::vector<cv::Point2f>& points);

// By sectors around a corner [Duda and Frese 2018], which finds blurred and small boards, and sees within a
// tenth of a second that there is none.
bool find_by_sectors(const cv::Mat& grey, const cv::Size& size, std::vector<cv::Point2f>& points) {
  return cv::findChessboardCornersSB(grey, size, points, kSectors);
}
// Squares of a few pixels are found in an image of twice the size.
bool find_in_double(const cv::Mat& grey, const cv::Size& size, std::vector<cv::Point2f>& points) {
  if (std::max(grey.cols, grey.rows) > kMostToDouble) return false;
  cv::Mat large;
  cv::resize(grey, large, {}, 2.0, 2.0, cv::INTER_LINEAR_EXACT);
  if (!find_by_sectors(large, size, points)) return false;
  for (cv::Point2f& p : points) p = (p - cv::Point2f(0.5F, 0.5F)) * 0.5F;
  return true;
}
// By the outlines of black squares. Where noise makes outlines by the thousand, the search takes minutes:
// blurred a little, a second.
bool find_by_outlines(const cv::Mat& grey, const cv::Size& size, std::vector<cv::Point2f>& points) {
  cv::Mat smooth;
  cv::GaussianBlur(grey, smooth, {3, 3}, 0.0);
  return cv::findChessboardCorners(smooth, size, points,
                                   cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE);
}

bool goes_on(const cv::Mat& grey, Grid grid) {
  for (int side = 0; side < 4; ++side, grid = calibration::turned(grid))
    if (calibration::beyond(grey, grid) == Beyond::goes_on) return true;
  return false;
}

std::optional<Corners> corners_by(const Finder& find, const cv::Mat& grey, const cv::Size& size) {
  Grid grid{size.width, size.height, {}};
  if (!find(grey, size, grid.points) || grid.points.size() != static_cast<std::size_t>(size.area()))
    return {};
  calibration::refine(grey, grid);
  if (!calibration::alternates(grey, grid) || goes_on(grey, grid)) return {};
  Corners corners;
  corners.reserve(grid.points.size());
  for (const cv::Point2f& p : grid.points) corners.emplace_back(p.x, p.y);
  return corners;
}

// What a board may have that is not of the size `near`. First what is seen at a glance, and one less or more
// of each, as who counts squares says; then the sizes around. Of both the largest first: part of a board may
// pass for a smaller one.
std::vector<cv::Size> sizes_around(const cv::Mat& grey, const cv::Size& near) {
  constexpr int kFewest = 3, kMost = 2,
                kPlain = 5;  // corners a side; more or fewer; a side of what is plainly seen
  std::vector<cv::Size> sizes{near - cv::Size(1, 1), near + cv::Size(1, 1)};
  std::vector<cv::Point2f> points;
  cv::Mat seen;
  for (const int least : {3, 4})
    if (cv::findChessboardCornersSB(grey, {least, least}, points, kSectors | cv::CALIB_CB_LARGER, seen) &&
        std::max(seen.cols, seen.rows) >= kPlain)
      sizes.emplace_back(seen.cols, seen.rows);
  const auto larger = [](const cv::Size& a, const cv::Size& b) { return a.area() > b.area(); };
  std::sort(sizes.begin(), sizes.end(), larger);
  const auto likely = static_cast<std::ptrdiff_t>(sizes.size());
  for (int columns = -kMost; columns <= kMost; ++columns)
    for (int rows = -kMost; rows <= kMost; ++rows) sizes.push_back(near + cv::Size(columns, rows));
  std::stable_sort(sizes.begin() + likely, sizes.end(), larger);
  std::erase_if(sizes, [](const cv::Size& s) { return s.width < kFewest || s.height < kFewest; });
  return sizes;
}

}  // namespace

std::optional<Corners> find_corners(const ImageView& image, const Board& board, Search search) {
  if (image.width < kSmallest || image.height < kSmallest) return {};
  const cv::Mat grey = grey_of(image);
  const cv::Size size(board.columns, board.rows);
  std::optional<Corners> corners = corners_by(find_by_sectors, grey, size);
  if (search == Search::quick) return corners;
  for (const Finder find : {find_in_double, find_by_outlines})
    if (!corners) corners = corners_by(find, grey, size);
  return corners;
}

std::optional<Board> board_in(const ImageView& image, const Board& near) {
  if (image.width < kSmallest || image.height < kSmallest) return {};
  const cv::Mat grey = grey_of(image);
  for (const cv::Size& size : sizes_around(grey, {near.columns, near.rows}))
    if (corners_by(find_by_sectors, grey, size))
      return Board{std::max(size.width, size.height), std::min(size.width, size.height), near.square};
  return {};
}

PairCorners in_one_order(Corners left, Corners right, const Board& board) {
  const auto columns = static_cast<std::size_t>(board.columns), rows = static_cast<std::size_t>(board.rows);
  const auto along = [&](const Corners& c) { return Eigen::Vector2d(c[columns - 1] - c[0]).normalized(); };
  const auto down = [&](const Corners& c) {
    return Eigen::Vector2d(c[columns * (rows - 1)] - c[0]).normalized();
  };
  const auto likeness = [&](const Corners& c) { return along(left).dot(along(c)) + down(left).dot(down(c)); };
  Corners best = right;
  for (int quarter = 1; quarter < 4; ++quarter) {
    if (columns != rows && quarter != 2) continue;
    Corners turned = right;
    if (quarter == 2)
      std::reverse(turned.begin(), turned.end());
    else
      for (std::size_t r = 0; r < rows; ++r)
        for (std::size_t c = 0; c < columns; ++c)
          turned[r * columns + c] =
              quarter == 1 ? right[c * columns + columns - 1 - r] : right[(columns - 1 - c) * columns + r];
    if (likeness(turned) > likeness(best)) best = std::move(turned);
  }
  return {std::move(left), std::move(best)};
}

}  // namespace enc
