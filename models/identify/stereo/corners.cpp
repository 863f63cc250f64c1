#include "models/identify/stereo/corners.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace enc {
namespace {

// A grid of corners in an image that may be part of a larger chessboard.
struct Grid {
  int columns = 0, rows = 0;
  std::vector<cv::Point2f> points;  // px, row by row

  [[nodiscard]] const cv::Point2f& at(int row, int column) const {
    return points[static_cast<std::size_t>(row * columns + column)];
  }
  [[nodiscard]] cv::Size size() const { return {columns, rows}; }
};

// The area beyond a side: the board goes on if the squares alternate there, and ends if a margin or
// background begins. The answer is open if the image ends before.
enum class Continuation : std::uint8_t { ends, goes_on, open };

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

// Predicts a row's next corner from the last three.
cv::Point2f next_of(const Grid& grid, int row) {
  const int c = grid.columns - 1;
  return 3.0F * grid.at(row, c) - 3.0F * grid.at(row, c - 1) + grid.at(row, c - 2);
}

// Moves the corners to their exact positions in the image, to a fraction of a pixel.
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

// True if the squares between the corners alternate between black and white.
bool alternates(const cv::Mat& grey, const Grid& grid) {
  constexpr double kLeast = 6.0;  // out of 255, between neighbours
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

// Examines the area beyond the last column. The grid must have at least three columns and rows.
Continuation beyond(const cv::Mat& grey, const Grid& grid) {
  constexpr float kInto = 0.3F;       // share of a square, from a corner into the four squares around it
  constexpr double kAlike = -0.5;     // share of the contrast before the corner, for the contrast behind it
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
  if (2 * seen < grid.rows + 1) return Continuation::open;
  return 4 * alternate >= 3 * seen ? Continuation::goes_on : Continuation::ends;
}

// A quarter turn: the last column becomes the first row.
Grid turned(const Grid& grid) {
  Grid out{grid.rows, grid.columns, {}};
  for (int r = 0; r < out.rows; ++r)
    for (int c = 0; c < out.columns; ++c) out.points.push_back(grid.at(c, grid.columns - 1 - r));
  return out;
}

constexpr int kSmallest = 16;        // px: OpenCV's finders need some margin
constexpr int kMostToDouble = 1600;  // px: larger images have squares of more than a few px
constexpr int kSectors = cv::CALIB_CB_EXHAUSTIVE | cv::CALIB_CB_NORMALIZE_IMAGE;

cv::Mat grey_of(const ImageView& image) {
  // OpenCV has no read-only matrix; the image is not written to.
  const cv::Mat colour(image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb));
  cv::Mat grey;
  cv::cvtColor(colour, grey, cv::COLOR_RGB2GRAY);
  return grey;
}

using Finder = bool (*)(const cv::Mat& grey, const cv::Size& size, std::vector<cv::Point2f>& points);

// Search by sectors around a corner [Duda and Frese 2018]. It finds blurred and small boards, and takes only
// a tenth of a second for an image without one.
bool find_by_sectors(const cv::Mat& grey, const cv::Size& size, std::vector<cv::Point2f>& points) {
  return cv::findChessboardCornersSB(grey, size, points, kSectors);
}
// Doubling the image finds squares of a few pixels.
bool find_in_double(const cv::Mat& grey, const cv::Size& size, std::vector<cv::Point2f>& points) {
  if (std::max(grey.cols, grey.rows) > kMostToDouble) return false;
  cv::Mat large;
  cv::resize(grey, large, {}, 2.0, 2.0, cv::INTER_LINEAR_EXACT);
  if (!find_by_sectors(large, size, points)) return false;
  for (cv::Point2f& p : points) p = (p - cv::Point2f(0.5F, 0.5F)) * 0.5F;
  return true;
}
// Search by the outlines of black squares. If noise makes thousands of outlines, it takes minutes; in a
// slightly blurred image, a second.
bool find_by_outlines(const cv::Mat& grey, const cv::Size& size, std::vector<cv::Point2f>& points) {
  cv::Mat smooth;
  cv::GaussianBlur(grey, smooth, {3, 3}, 0.0);
  return cv::findChessboardCorners(smooth, size, points,
                                   cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE);
}

bool goes_on(const cv::Mat& grey, Grid grid) {
  for (int side = 0; side < 4; ++side, grid = turned(grid))
    if (beyond(grey, grid) == Continuation::goes_on) return true;
  return false;
}

std::optional<Corners> corners_by(const Finder& find, const cv::Mat& grey, const cv::Size& size) {
  Grid grid{size.width, size.height, {}};
  if (!find(grey, size, grid.points) || grid.points.size() != static_cast<std::size_t>(size.area()))
    return {};
  refine(grey, grid);
  if (!alternates(grey, grid) || goes_on(grey, grid)) return {};
  Corners corners;
  corners.reserve(grid.points.size());
  for (const cv::Point2f& p : grid.points) corners.emplace_back(p.x, p.y);
  return corners;
}

// Candidate sizes for a board that is not of size `near`. First the clearly visible size and `near`, each
// plus and minus one, because people count squares; then the sizes around them. The largest come first,
// because part of a board may pass for a smaller one.
std::vector<cv::Size> sizes_around(const cv::Mat& grey, const cv::Size& near) {
  constexpr int kFewest = 3, kMost = 2,
                kPlain = 5;  // corners a side; more or fewer; side of a clearly visible board
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
