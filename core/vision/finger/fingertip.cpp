#include "core/vision/finger/fingertip.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/spec/vision_check.h"
#include "core/vision/finger/cap.h"

namespace enc {
namespace {

constexpr double kDiscsPerPixel = 4.0;  // discs per px of radius

std::size_t at(int width, int y, int x) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

}  // namespace

FingertipFinder::FingertipFinder(const FingertipSpec& spec, const RectifiedPair& pair, double r_most,
                                 int width, int height)
    : spec_(spec),
      pair_(pair),
      per_disparity_(spec.radius / pair.baseline * spec.scale),
      r_most_(r_most * spec.scale),
      width_(width),
      height_(height) {
  check(spec, per_disparity_, r_most_);
  for (int i = 0; i <= static_cast<int>(std::ceil(r_most_ * kDiscsPerPixel)) + 1; ++i) {
    const double r2 = (i / kDiscsPerPixel) * (i / kDiscsPerPixel);
    Disc disc;
    for (int dy = 0; dy * dy <= r2; ++dy) {
      disc.half.push_back(static_cast<std::int16_t>(std::sqrt(r2 - dy * dy)));
      disc.area += (dy == 0 ? 1 : 2) * (2 * disc.half.back() + 1);
    }
    discs_.push_back(std::move(disc));
  }
  const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
  rows_.resize((w + 1) * h);
  columns_.resize(w * (h + 1));
  candidates_.reserve(w * h);
}

const FingertipFinder::Disc& FingertipFinder::disc(double radius) const {
  return discs_[std::min(discs_.size() - 1, static_cast<std::size_t>(radius * kDiscsPerPixel + 0.5))];
}

int FingertipFinder::half_side(double radius) const {
  const double r2 = spec_.square_radii * radius;
  return std::max(1, static_cast<int>((spec_.square == SquareReading::side ? 0.5 * r2 : r2) + 0.5));
}

int FingertipFinder::stretch(double radius) const {
  return static_cast<int>(spec_.stretch_radii * radius + 0.5);
}

int FingertipFinder::reach(double disparity) const {
  const double radius = std::min(radius_of(disparity), r_most_);
  // The middle of the best candidates is at most one radius away from the first of them.
  return std::max({half_side(radius), stretch(radius), static_cast<int>(radius * (1.0 + kFarthest))}) + 2;
}

// Sums of skin to the left of and above each pixel.
void FingertipFinder::sum(const Mask& skin, const Region& part) {
  part_ = part;
  const std::size_t first = at(width_, part.y0, 0);
  std::fill(columns_.begin() + static_cast<std::ptrdiff_t>(first) + part.x0,
            columns_.begin() + static_cast<std::ptrdiff_t>(first) + part.x1, std::uint16_t{0});
  for (int y = part.y0; y < part.y1; ++y) {
    const std::uint8_t* on = skin.row(y);
    std::uint16_t* row = rows_.data() + at(width_ + 1, y, 0);
    const std::uint16_t* above = columns_.data() + at(width_, y, 0);
    std::uint16_t* below = columns_.data() + at(width_, y + 1, 0);
    std::uint16_t sum = 0;
    row[part.x0] = 0;
    for (int x = part.x0; x < part.x1; ++x) {
      sum = static_cast<std::uint16_t>(sum + (on[x] >> 7U));
      row[x + 1] = sum;
    }
    for (int x = part.x0; x < part.x1; ++x) below[x] = static_cast<std::uint16_t>(above[x] + (on[x] >> 7U));
  }
}

int FingertipFinder::in_row(int y, int x0, int x1) const {
  if (y < part_.y0 || y >= part_.y1) return 0;
  const std::uint16_t* row = rows_.data() + at(width_ + 1, y, 0);
  return x1 < part_.x0 || x0 >= part_.x1 ? 0 : row[std::min(x1 + 1, part_.x1)] - row[std::max(x0, part_.x0)];
}

int FingertipFinder::in_column(int x, int y0, int y1) const {
  if (x < part_.x0 || x >= part_.x1 || y1 < part_.y0 || y0 >= part_.y1) return 0;
  return columns_[at(width_, std::min(y1 + 1, part_.y1), x)] -
         columns_[at(width_, std::max(y0, part_.y0), x)];
}

int FingertipFinder::in_circle(int x, int y, const Disc& disc) const {
  const int r = static_cast<int>(disc.half.size()) - 1;
  const bool inside = x - r >= part_.x0 && x + r < part_.x1 && y - r >= part_.y0 && y + r < part_.y1;
  if (!inside) {
    int count = in_row(y, x - r, x + r);
    for (int dy = 1; dy <= r; ++dy) {
      const int half = disc.half[static_cast<std::size_t>(dy)];
      count += in_row(y - dy, x - half, x + half) + in_row(y + dy, x - half, x + half);
    }
    return count;
  }
  const std::ptrdiff_t stride = width_ + 1;
  const std::uint16_t* here = rows_.data() + at(width_ + 1, y, x);
  int count = here[r + 1] - here[-r];
  for (std::ptrdiff_t dy = 1; dy <= r; ++dy) {
    const std::ptrdiff_t half = disc.half[static_cast<std::size_t>(dy)];
    const std::uint16_t *above = here - dy * stride, *below = here + dy * stride;
    count += above[half + 1] - above[-half] + below[half + 1] - below[-half];
  }
  return count;
}

int FingertipFinder::along_square(int x, int y, int half) const {
  return in_row(y - half, x - half, x + half) + in_row(y + half, x - half, x + half) +
         in_column(x - half, y - half + 1, y + half - 1) + in_column(x + half, y - half + 1, y + half - 1);
}

// Counts opposite pixels of S on both sides of (x, y) that are both skin; half of S is enough.
int FingertipFinder::diagonal_pairs(const Mask& skin, int x, int y, int half) const {
  const auto on = [&](int column, int row) { return part_.contains(column, row) && skin.at(column, row); };
  int pairs = 0;
  for (int i = -half; i < half; ++i) {
    pairs += on(x + i, y - half) && on(x - i, y + half) ? 1 : 0;
    pairs += on(x + half, y + i) && on(x - half, y - i) ? 1 : 0;
  }
  return pairs;
}

// Steps 1 to 10 of one pixel, numbered as printed.
void FingertipFinder::look_at(const Mask& skin, const DisparityMap& disparity, int x, int y) {
  ++counts_.visited;
  if (!skin.at(x, y)) {  // 1
    ++counts_.no_skin;
    return;
  }
  const double d = disparity.at(x, y);  // 2: z = f B / d; a pixel without depth is not on a fingertip
  if (!(d > 0.0)) {
    ++counts_.no_depth;
    return;
  }
  const double radius = radius_of(d);  // 3: r = K / z
  if (!(radius >= spec_.radius_least && radius <= r_most_)) {
    ++counts_.too_small;
    return;
  }
  const Disc& circle = disc(radius);
  const double share = static_cast<double>(in_circle(x, y, circle)) / circle.area;  // 4
  if (share < spec_.circle_share) {                                                 // 5
    ++counts_.circle;
    return;
  }
  const int half = half_side(radius);
  const bool whole = x >= half && y >= half && x + half < width_ && y + half < height_;
  const int along = whole ? along_square(x, y, half) : 0;  // 6; a finger cut by the border has no end
  if (!whole || along < spec_.square_least * radius || along > spec_.square_most * radius) {  // 7
    ++counts_.square;
    return;
  }
  if (diagonal_pairs(skin, x, y, half) > spec_.pairs) {  // 8, 9
    ++counts_.pairs;
    return;
  }
  ++counts_.candidates;  // 10
  const bool straight =
      spec_.stretch_radii <= 0.0 || along_square(x, y, stretch(radius)) <= spec_.stretch_most * radius;
  candidates_.push_back({x, y, static_cast<float>(share), static_cast<float>(radius), straight});
}

Fingertip FingertipFinder::find(const Mask& skin, const DisparityMap& disparity, const Region& search,
                                const Triplet& expected) {
  counts_ = {};
  candidates_.clear();
  top_count_ = 0;
  const Region frame{0, 0, width_, height_};
  const Region cut = search.cut(frame);
  if (cut.empty() || skin.width != width_ || skin.height != height_) return {};
  const int far = std::max({half_side(r_most_), stretch(r_most_), static_cast<int>(r_most_)}) + 1;
  sum(skin, Region{cut.x0 - far, cut.y0 - far, cut.x1 + far, cut.y1 + far}.cut(frame));
  for (int y = cut.y0; y < cut.y1; ++y)
    for (int x = cut.x0; x < cut.x1; ++x) look_at(skin, disparity, x, y);
  choose(expected);
  return tip(skin, 0);
}

// Selects the best fingertip, and others of similar quality that are far enough away to be other fingers. The
// order is by score, or by distance to the predicted position of the finger.
void FingertipFinder::choose(const Triplet& expected) {
  constexpr double kApart = 3.0;        // radii
  constexpr float kAboutAsGood = 0.1F;  // of score
  top_count_ = 0;
  const auto less = [](const Candidate& a, const Candidate& b) {
    return a.straight == b.straight ? a.score < b.score : b.straight;
  };
  const auto other = [&](const Candidate& one) {
    if (top_count_ > 0 && one.score < tops_[0].score - kAboutAsGood) return false;
    return std::all_of(
        tops_.begin(), tops_.begin() + static_cast<std::ptrdiff_t>(top_count_), [&](const Candidate& top) {
          return std::hypot(one.x - top.x, one.y - top.y) > kApart * static_cast<double>(top.radius);
        });
  };
  while (top_count_ < tops_.size()) {
    const Candidate* next = nullptr;
    for (const Candidate& one : candidates_)
      if ((next == nullptr || less(*next, one)) && other(one)) next = &one;
    if (next == nullptr) break;
    tops_[top_count_++] = *next;
  }
  if (std::isnan(expected.column)) return;
  const auto off = [&](const Candidate& one) {
    return std::hypot(one.x - expected.column, one.y - expected.row);
  };
  const auto nearer = [&](const Candidate& a, const Candidate& b) { return off(a) < off(b); };
  for (auto* one = tops_.data(); one != tops_.data() + top_count_; ++one)
    std::rotate(std::upper_bound(tops_.data(), one, *one, nearer), one, one + 1);
}

Fingertip FingertipFinder::tip(const Mask& skin, std::size_t index) const {
  if (index >= top_count_) return {};
  const Candidate& top = tops_[index];
  std::int64_t x = 0, y = 0, count = 0;
  for (const Candidate& one : candidates_) {
    const int dx = one.x - top.x, dy = one.y - top.y;
    if (one.score != top.score || one.straight != top.straight ||
        static_cast<float>(dx * dx + dy * dy) > top.radius * top.radius)
      continue;
    x += one.x;
    y += one.y;
    ++count;
  }
  Fingertip tip;
  tip.found = true;
  tip.x = top.x;
  tip.y = top.y;
  tip.column = static_cast<double>(x) / static_cast<double>(count);
  tip.row = static_cast<double>(y) / static_cast<double>(count);
  tip.radius = tip.outline = static_cast<double>(top.radius);
  tip.score = static_cast<double>(top.score);
  if (!spec_.fit) return tip;
  const CapFit fit = fit_cap(skin, pair_, {tip.column, tip.row}, tip.radius);
  tip.along_x = fit.along_x;
  tip.along_y = fit.along_y;
  if (!fit.good) return tip;
  tip.fitted = true;
  tip.column = fit.centre.column;
  tip.row = fit.centre.row;
  tip.outline = fit.radius;
  return tip;
}

namespace {

constexpr double kRound = 1.8;         // radii around the cap's middle that are compared
constexpr int kMostPixels = 1024;      // compared pixels, evenly spread
constexpr double kAboutAsGood = 0.04;  // share of pixels
constexpr double kTells = 0.1;         // share: if all shifts fit alike, the shape decides nothing
constexpr int kApart = 4;              // px

struct Lay {
  int x0, x1, y0, y1, step;
  Lay(const Fingertip& tip, const Region& image) {
    const double far = kRound * tip.outline;
    const Region box = Region{static_cast<int>(tip.column - far), static_cast<int>(tip.row - far),
                              static_cast<int>(tip.column + far) + 1, static_cast<int>(tip.row + far) + 1}
                           .cut(image);
    x0 = box.x0, x1 = box.x1, y0 = box.y0, y1 = box.y1;
    step =
        std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(box.pixels()) / kMostPixels))));
  }
};

// Share of the pixels that are skin in both images or in neither; positions outside of the right image count
// as no skin.
double alike(const Mask& left, const Mask& right, const Lay& lay, int shift) {
  int same = 0, all = 0;
  for (int y = lay.y0; y < lay.y1; y += lay.step)
    for (int x = lay.x0; x < lay.x1; x += lay.step, ++all)
      same += x >= shift && left.at(x, y) == right.at(x - shift, y) ? 1 : 0;
  return all == 0 ? 0.0 : static_cast<double>(same) / all;
}

}  // namespace

Region opposite(const Fingertip& tip, const ShiftRange& range, const Region& image) {
  const Lay lay(tip, image);
  return Region{lay.x0 - range.most, lay.y0, lay.x1 - range.least, lay.y1}.cut(image);
}

std::size_t alike_shapes(const Mask& left, const Mask& right, const Fingertip& tip, const ShiftRange& range,
                         std::span<float> shifts) {
  const Lay lay(tip, left.whole());
  std::array<double, 512> share{};
  const int most = std::min(range.most, range.least + static_cast<int>(share.size()) - 1);
  const auto of = [&](int shift) -> double& { return share[static_cast<std::size_t>(shift - range.least)]; };
  double best = 0.0, worst = 1.0;
  for (int shift = range.least; shift <= most; ++shift) {
    of(shift) = alike(left, right, lay, shift);
    best = std::max(best, of(shift));
    if (shift <= lay.x0) worst = std::min(worst, of(shift));  // the whole shape is in the image
  }
  if (best - worst < kTells) return 0;
  std::size_t count = 0;
  for (; count < shifts.size(); ++count) {
    int top = range.least;
    for (int shift = range.least; shift <= most; ++shift)
      if (of(shift) > of(top)) top = shift;
    if (!(of(top) > 0.0) || of(top) < best - kAboutAsGood) break;
    shifts[count] = static_cast<float>(top);
    for (int shift = std::max(range.least, top - kApart); shift <= std::min(most, top + kApart); ++shift)
      of(shift) = 0.0;
  }
  return count;
}

}  // namespace enc
