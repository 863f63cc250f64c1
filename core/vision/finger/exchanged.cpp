#include "core/vision/finger/exchanged.h"

#include <algorithm>

#include "core/spec/vision/vision_check.h"

namespace enc {
namespace {

// Large blocks: a room has little that is like itself elsewhere, and its depth does not matter. Farther than
// a person works, too, for that is where the walls are.
constexpr int kColumnsOfBlock = 16, kRowsOfBlock = 15;  // px
constexpr int kSteps = 5;                               // frames after which the places are the same again

MatchSpec blocks(const RectifiedPair& pair) {
  constexpr double kNearest = 0.4, kFarthest = 20.0;  // m
  const double nearest = std::max(kNearest, pair.focal * pair.baseline / (kMostDisparity - 1));
  return {kColumnsOfBlock, kRowsOfBlock, nearest, std::max(kFarthest, 2.0 * nearest)};
}

}  // namespace

Exchanged::Exchanged(const RectifiedPair& pair, int width, int height)
    : matcher_(blocks(pair), pair), width_(width), height_(height) {}

Region Exchanged::strip(int row) const {
  const int y = (2 * row + 1) * height_ / (2 * kRows);
  return Region{0, y - kRowsOfBlock / 2, width_, y + kRowsOfBlock / 2 + 1}.cut({0, 0, width_, height_});
}

// Every frame looks at other columns, so that one bare patch of wall is not all that is ever asked.
int Exchanged::matched(const Grey& left, const Grey& right) {
  int count = 0;
  for (int row = 0; row < kRows; ++row) {
    const int y = (2 * row + 1) * height_ / (2 * kRows);
    for (int column = 0; column < kColumns; ++column) {
      const int x = (kSteps * column + frame_ % kSteps) * width_ / (kSteps * kColumns);
      count += matcher_.at(left, right, x, y).matched == Matched::yes ? 1 : 0;
    }
  }
  return count;
}

bool Exchanged::see(const Grey& left, const Grey& right) {
  const int ahead = matched(left, right), behind = matched(right, left);
  ++frame_;
  if (behind >= kLeast && behind > kClear * ahead) exchanged_ = true;
  if (ahead >= kLeast && ahead > kClear * behind) exchanged_ = false;
  return exchanged_;
}

}  // namespace enc
