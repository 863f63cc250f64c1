#include "core/vision/stereo/match.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "core/spec/vision_check.h"

namespace enc {
namespace {

constexpr int kBeside = 2;  // px on either side of the best position that belong to it

bool all_on(const Mask& mask, int x0, int y0, int columns, int rows) {
  for (int y = y0; y < y0 + rows; ++y)
    if (std::memchr(mask.row(y) + x0, 0, static_cast<std::size_t>(columns)) != nullptr) return false;
  return true;
}

static_assert(kMostDisparity == match_kernel::kMost);

}  // namespace

Matcher::Matcher(const MatchSpec& spec, const RectifiedPair& pair, const match_kernel::Kernel& kernel)
    : spec_(spec), kernel_(kernel) {
  const double product = pair.focal * pair.baseline;
  check(spec, product);
  const double most = std::ceil(product / spec.nearest);
  most_ = std::max(2, static_cast<int>(most));
  least_ = std::max(0, static_cast<int>(std::floor(product / spec.farthest)) - 1);
}

Region Matcher::left_of(const Region& wanted) const {
  const int aside = spec_.columns / 2 + (spec_.agreement >= 0.0 ? most_ - least_ : 0);
  return {wanted.x0 - aside, wanted.y0 - spec_.rows / 2, wanted.x1 + aside, wanted.y1 + spec_.rows / 2};
}

Region Matcher::right_of(const Region& wanted) const {
  return {wanted.x0 - most_ - spec_.columns / 2, wanted.y0 - spec_.rows / 2,
          wanted.x1 - least_ + spec_.columns / 2, wanted.y1 + spec_.rows / 2};
}

void Matcher::compare(const Block& block, const std::uint8_t* strip, std::size_t stride, int count) {
  if (block.on != nullptr)
    kernel_.compare_masked(block.level, block.stride, block.on, block.on_stride, strip, stride, spec_.columns,
                           spec_.rows, count, cost_.data());
  else
    kernel_.compare(block.level, block.stride, strip, stride, spec_.columns, spec_.rows, count, cost_.data());
}

// A block of even width has its middle between two columns. The upper left pixel of the block of (x, y) is (x
// - columns / 2, y - rows / 2).
Disparity Matcher::at(const Grey& left, const Grey& right, int x, int y, const Mask* mask) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const int x0 = x - spec_.columns / 2, y0 = y - spec_.rows / 2;
  const bool inside =
      x0 >= 0 && y0 >= 0 && x0 + spec_.columns <= left.width && y0 + spec_.rows <= left.height;
  const int most = std::min(most_, x0);
  const int count = most - least_ + 1;
  if (!inside || count < 3) return {MatchOutcome::outside, kNone};
  std::uint16_t* cost = cost_.data();
  Block block{left.at(x0, y0), left.stride, nullptr, 0};
  if (mask != nullptr && !all_on(*mask, x0, y0, spec_.columns, spec_.rows)) {
    block.on = mask->row(y0) + x0;
    block.on_stride = static_cast<std::size_t>(mask->width);
  }
  compare(block, right.at(x0 - most, y0), right.stride, count);
  const int best = kernel_.least(cost, count);
  if (best == 0 || best == count - 1) return {MatchOutcome::at_limit, kNone};
  const int below = cost[best - 1], lowest = cost[best], above = cost[best + 1];
  const int from = std::max(0, best - kBeside), to = std::min(count - 1, best + kBeside);
  std::fill(cost + from, cost + to + 1, std::uint16_t{0xffff});
  const int next = cost[kernel_.least(cost, count)];
  if (static_cast<double>(next) <= (1.0 + spec_.uniqueness) * lowest)
    return {MatchOutcome::not_unique, kNone};
  const int disparity = most - best;
  block.level = right.at(x0 - disparity, y0);
  block.stride = right.stride;
  if (spec_.agreement >= 0.0 && !mutual(left, block, x0 - disparity, y0, disparity))
    return {MatchOutcome::not_mutual, kNone};
  const int bend = below - 2 * lowest + above;
  const double shift = bend > 0 ? 0.5 * (below - above) / bend : 0.0;  // shift of the position to the right
  return {MatchOutcome::yes, static_cast<float>(disparity - shift)};
}

// Searches the left image for a block at `column` of the right one.
bool Matcher::mutual(const Grey& left, const Block& block, int column, int y, int disparity) {
  const int most = std::min(most_, left.width - spec_.columns - column);
  compare(block, left.at(column + least_, y), left.stride, most - least_ + 1);
  const int back = least_ + kernel_.least(cost_.data(), most - least_ + 1);
  return std::abs(back - disparity) <= spec_.agreement;
}

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

std::size_t cells(int pixels) {
  return static_cast<std::size_t>((pixels + DisparityMap::kCell - 1) / DisparityMap::kCell);
}

}  // namespace

DisparityMap::DisparityMap(int width, int height)
    : columns_(cells(width)),
      rows_(cells(height)),
      raw_(columns_ * rows_, kNone),
      smooth_(columns_ * rows_, kNone) {}

void DisparityMap::fill(float disparity) {
  std::fill(raw_.begin(), raw_.end(), disparity);
  std::fill(smooth_.begin(), smooth_.end(), disparity);
}

void DisparityMap::match(Matcher& matcher, const Grey& left, const Grey& right, const Mask& mask,
                         const Region& wanted) {
  const int last_column = static_cast<int>(columns_) - 1, last_row = static_cast<int>(rows_) - 1;
  const Region inner{wanted.x0 / kCell, wanted.y0 / kCell, (wanted.x1 - 1) / kCell, (wanted.y1 - 1) / kCell};
  sought_ = found_ = 0;
  if (wanted.empty()) return;
  for (int row = std::max(0, inner.y0 - 1); row <= std::min(last_row, inner.y1 + 1); ++row)
    for (int column = std::max(0, inner.x0 - 1); column <= std::min(last_column, inner.x1 + 1); ++column) {
      const int x = column * kCell + kCell / 2, y = row * kCell + kCell / 2;
      float& value = raw_[static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column)];
      value = kNone;
      if (x >= mask.width || y >= mask.height || !mask.at(x, y)) continue;
      value = matcher.at(left, right, x, y, &mask).pixels;
      ++sought_;
      found_ += std::isfinite(value) ? 1 : 0;
    }
  for (int row = inner.y0; row <= inner.y1; ++row)
    for (int column = inner.x0; column <= inner.x1; ++column) {
      const auto c = static_cast<std::size_t>(column), r = static_cast<std::size_t>(row);
      smooth_[r * columns_ + c] = median_round(c, r);
    }
}

// The lower of the two middle values, so that it is a measured one.
float DisparityMap::median_round(std::size_t column, std::size_t row) const {
  std::array<float, 9> values{};
  std::size_t count = 0;
  for (std::size_t r = row == 0 ? 0 : row - 1; r <= std::min(rows_ - 1, row + 1); ++r)
    for (std::size_t c = column == 0 ? 0 : column - 1; c <= std::min(columns_ - 1, column + 1); ++c) {
      const float value = raw_[r * columns_ + c];
      if (!std::isfinite(value)) continue;
      std::size_t i = count++;
      for (; i > 0 && values[i - 1] > value; --i) values[i] = values[i - 1];
      values[i] = value;
    }
  return count == 0 ? kNone : values[(count - 1) / 2];
}

namespace {

// Large blocks, because rooms seldom repeat at that size, and the depth need not be exact. The range extends
// farther than a person works, because the walls are there.
constexpr int kColumnsOfBlock = 16, kRowsOfBlock = 15;  // px
constexpr int kSteps = 5;                               // frames after which the examined positions repeat

MatchSpec blocks(const RectifiedPair& pair) {
  constexpr double kNearest = 0.4, kFarthest = 20.0;  // m
  const double nearest = std::max(kNearest, pair.focal * pair.baseline / (kMostDisparity - 1));
  return {kColumnsOfBlock, kRowsOfBlock, nearest, std::max(kFarthest, 2.0 * nearest)};
}

}  // namespace

ExchangeCheck::ExchangeCheck(const RectifiedPair& pair, int width, int height)
    : matcher_(blocks(pair), pair), width_(width), height_(height) {}

Region ExchangeCheck::strip(int row) const {
  const int y = (2 * row + 1) * height_ / (2 * kRows);
  return Region{0, y - kRowsOfBlock / 2, width_, y + kRowsOfBlock / 2 + 1}.cut({0, 0, width_, height_});
}

// Every frame examines other columns, so that one bare patch of wall does not spoil all answers.
int ExchangeCheck::matched(const Grey& left, const Grey& right) {
  int count = 0;
  for (int row = 0; row < kRows; ++row) {
    const int y = (2 * row + 1) * height_ / (2 * kRows);
    for (int column = 0; column < kColumns; ++column) {
      const int x = (kSteps * column + frame_ % kSteps) * width_ / (kSteps * kColumns);
      count += matcher_.at(left, right, x, y).matched == MatchOutcome::yes ? 1 : 0;
    }
  }
  return count;
}

bool ExchangeCheck::see(const Grey& left, const Grey& right) {
  const int ahead = matched(left, right), behind = matched(right, left);
  ++frame_;
  if (behind >= kLeast && behind > kClear * ahead) exchanged_ = true;
  if (ahead >= kLeast && ahead > kClear * behind) exchanged_ = false;
  return exchanged_;
}

}  // namespace enc
