#include "core/vision/finger/cap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "core/vision/stereo/grey.h"

namespace enc {
namespace {

constexpr std::size_t kRays = 48;
constexpr int kFitRounds = 6;

struct Direction {
  double x, y;
};
const std::array<Direction, kRays>& directions() {
  static const std::array<Direction, kRays> kAll = [] {
    std::array<Direction, kRays> all{};
    for (std::size_t i = 0; i < kRays; ++i) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / kRays;
      all[i] = {std::cos(angle), std::sin(angle)};
    }
    return all;
  }();
  return kAll;
}

// The part of the mask that the fit may read, so that its result does not depend on what was segmented
// beyond.
struct MaskWindow {
  const Mask& skin;
  Region part;
};

// Share of skin at a position between pixels; 0 outside.
double skin_at(const MaskWindow& around, double x, double y) {
  const Mask& skin = around.skin;
  const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
  if (!around.part.contains(left, top) || !around.part.contains(left + 1, top + 1)) return 0.0;
  const double right = x - left, down = y - top;
  const std::uint8_t *a = skin.row(top) + left, *b = skin.row(top + 1) + left;
  return ((a[0] * (1.0 - right) + a[1] * right) * (1.0 - down) +
          (b[0] * (1.0 - right) + b[1] * right) * down) /
         255.0;
}

// Distance to the edge; NaN if the start is not in the mask or the edge is farther than `most`.
double edge_along(const MaskWindow& skin, const Pixel& from, const Direction& to, double least, double most) {
  constexpr double kStep = 0.5;
  double before = skin_at(skin, from.column + least * to.x, from.row + least * to.y);
  if (before < 0.5) return kUnset;
  const auto steps = static_cast<int>((most - least) / kStep);
  for (int i = 1; i <= steps; ++i) {
    const double t = least + kStep * i;
    const double now = skin_at(skin, from.column + t * to.x, from.row + t * to.y);
    if (now < 0.5) return t - kStep * (0.5 - now) / (before - now);
    before = now;
  }
  return kUnset;
}

// Brightness between pixels; 0 outside.
double level_at(const Grey& image, double x, double y) {
  const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
  if (left < 0 || top < 0 || left + 1 >= image.width || top + 1 >= image.height) return 0.0;
  const double right = x - left, down = y - top;
  const std::uint8_t *a = image.at(left, top), *b = image.at(left, top + 1);
  return (a[0] * (1.0 - right) + a[1] * right) * (1.0 - down) + (b[0] * (1.0 - right) + b[1] * right) * down;
}

// The sharpest change of brightness, from a little inside the mask's edge to where hue may have missed the
// finger. Returns the mask's edge if brightness hardly changes.
double sharpest(const Grey& image, const Pixel& from, const Direction& to, double edge) {
  constexpr double kStep = 0.5, kHalf = 0.75, kLeast = 6.0;  // px, px, levels
  constexpr std::size_t kInside = 2, kSteps = 9;
  std::array<double, kSteps> change{};
  std::size_t best = 0;
  for (std::size_t i = 0; i < kSteps; ++i) {
    const double t = edge + kStep * (static_cast<double>(i) - kInside), in = t - kHalf, out = t + kHalf;
    change[i] = std::abs(level_at(image, from.column + out * to.x, from.row + out * to.y) -
                         level_at(image, from.column + in * to.x, from.row + in * to.y));
    if (change[i] > change[best]) best = i;
  }
  if (best == 0 || best == kSteps - 1 || change[best] < kLeast) return edge;
  const double bend = change[best - 1] - 2.0 * change[best] + change[best + 1];
  const double aside = bend < 0.0 ? 0.5 * (change[best - 1] - change[best + 1]) / bend : 0.0;
  return edge + kStep * (static_cast<double>(best) - kInside + aside);
}

// Direction towards the rest of the finger on a circle around the tip; zero if the circle has no skin or skin
// on all sides.
Direction knuckle(const MaskWindow& skin, const Tangent& tangent, double radius) {
  Direction sum{0.0, 0.0};
  for (const Direction& d : directions()) {
    const Pixel at = tangent.image({radius * d.x, radius * d.y});
    if (skin_at(skin, at.column, at.row) < 0.5) continue;
    sum.x += d.x;
    sum.y += d.y;
  }
  const double norm = std::sqrt(sum.x * sum.x + sum.y * sum.y);
  return norm < 1.0 ? Direction{0.0, 0.0} : Direction{sum.x / norm, sum.y / norm};
}

struct Round {
  Mat3 normal = Mat3::Zero();
  Vec3 right = Vec3::Zero();
  double squares = 0.0;
  int edges = 0;
};

// Adds one edge: its distance from the outline, and the derivatives by middle and radius.
void take(double x, double y, const Direction& along, double radius, double most, Round& round) {
  const double back = x * along.x + y * along.y;
  double far = std::sqrt(x * x + y * y), nx = x / far, ny = y / far;  // the cap
  if (back > 0.0) {                                                   // a side
    const double across = x * -along.y + y * along.x;
    far = std::abs(across);
    nx = across < 0.0 ? along.y : -along.y;
    ny = across < 0.0 ? -along.x : along.x;
  }
  const double off = far - radius;
  if (std::abs(off) > most) return;
  const Vec3 slope(nx, ny, 1.0);
  round.normal += slope * slope.transpose();
  round.right += slope * off;
  round.squares += off * off;
  ++round.edges;
}

// Searches edges along straight lines of the image, and evaluates them in the view where they are circles.
Round look(const MaskWindow& skin, const Grey* image, const Tangent& tangent, const CapFit& now,
           double most) {
  Round round;
  const Direction along{now.along_x, now.along_y};
  for (const Direction& d : directions()) {
    if (d.x * along.x + d.y * along.y > 0.5) continue;  // down the finger
    const Pixel rim = tangent.image({now.radius * d.x, now.radius * d.y});
    const double x = rim.column - now.centre.column, y = rim.row - now.centre.row;
    const double length = std::sqrt(x * x + y * y);
    const Direction to{x / length, y / length};
    double far = edge_along(skin, now.centre, to, 0.2 * length, 2.5 * length);
    if (!(far > 0.0)) continue;
    if (image != nullptr) far = sharpest(*image, now.centre, to, far);
    const Pixel edge = tangent.of({now.centre.column + far * to.x, now.centre.row + far * to.y});
    take(edge.column, edge.row, along, now.radius, most, round);
  }
  return round;
}

constexpr int kFewestEdges = 12;  // edges

MaskWindow around(const Mask& mask, const Pixel& start, double radius) {
  const int x = static_cast<int>(start.column), y = static_cast<int>(start.row);
  const int far = static_cast<int>(kFarthest * radius);
  return {mask, Region{x - far, y - far, x + far + 1, y + far + 1}.cut(mask.whole())};
}

// False if there are too few edges to fit.
bool improve(const MaskWindow& skin, const Grey* image, const RectifiedPair& pair, double knuckle_at,
             double most, CapFit& fit) {
  const Tangent tangent(pair, fit.centre);
  const Direction along = knuckle(skin, tangent, knuckle_at * fit.radius);
  if (along.x == 0.0 && along.y == 0.0) return false;
  fit.along_x = along.x;
  fit.along_y = along.y;
  const Round round = look(skin, image, tangent, fit, most);
  if (round.edges < kFewestEdges) return false;
  const Vec3 step = Mat3(round.normal + 1e-6 * Mat3::Identity()).inverse() * round.right;
  fit.centre = tangent.image({step.x(), step.y()});
  fit.radius += step.z();
  fit.misfit = std::sqrt(round.squares / round.edges);
  return true;
}

}  // namespace

CapFit fit_cap(const Mask& mask, const RectifiedPair& pair, const Pixel& start, double radius) {
  const MaskWindow skin = around(mask, start, radius);
  CapFit fit{false, start, radius};
  for (int i = 0; i < kFitRounds; ++i) {
    // The first rounds look beyond the square's corner, because a finger may extend far behind its tip; but
    // not beyond the end of the image.
    const double most = (i < 2 ? 1.5 : 0.35) * fit.radius;
    const bool begun = i == 0 && improve(skin, nullptr, pair, 2.4, most, fit);
    if (!begun && !improve(skin, nullptr, pair, 1.6, most, fit)) return fit;
    const double off = std::hypot(fit.centre.column - start.column, fit.centre.row - start.row);
    if (!(off < 2.0 * radius && fit.radius > 0.4 * radius && fit.radius < 2.0 * radius)) return fit;
  }
  fit.good = fit.misfit < 0.15 * fit.radius + 0.3;
  return fit;
}

CapFit sharpen_cap(const Mask& mask, const Grey& image, const RectifiedPair& pair, const CapFit& fit) {
  const MaskWindow skin = around(mask, fit.centre, fit.radius);
  CapFit sharp = fit;
  for (int i = 0; i < 4; ++i) {
    // The last rounds reject edges of anything else.
    const double most = i < 2 ? 0.35 * fit.radius : std::max(1.0, 0.1 * fit.radius);
    if (!improve(skin, &image, pair, 1.6, most, sharp)) return fit;
  }
  const double off = std::hypot(sharp.centre.column - fit.centre.column, sharp.centre.row - fit.centre.row);
  return off < 3.0 && std::abs(sharp.radius - fit.radius) < 3.0 ? sharp : fit;
}

namespace {

constexpr double kFrontShare = 0.9;  // block's lead over the cap's middle, as a share of the radius
constexpr double kVague = 1.0;       // px, error of a block
constexpr int kFewest = 16;          // pixels
constexpr std::size_t kMost = 512;   // compared pixels, evenly spread
constexpr std::size_t kFirst = 256;  // at first
constexpr double kBehind = 1.0;      // radii of the finger behind the cap that are compared
// Cosine of 60 degrees: a more oblique surface lies within a seventh of a radius of the rim, where a pixel
// contains some background in both images.
constexpr double kAslant = 0.5;
constexpr double kSlopes = 0.3;    // rad rms, slope of fingers against the image
constexpr double kSteepest = 1.2;  // rad
constexpr double kLittle = 1e-3;   // rad, step of the derivative
// Smoothing of each pixel (rms), as a share of a cap's radius, so that dark skin seen from near shows more
// detail than noise. Twice as much mixes in the surroundings beyond the rim.
constexpr double kSmooth = 1.0 / 18.0;
constexpr int kMostPasses = 8;  // px

// A grey level between two columns: the cubic through four [Catmull and Rom], and its slope.
struct Level {
  double value, slope;
};
Level level_at(const SmoothGrey& image, double x, int y) {
  const int left = static_cast<int>(std::floor(x));
  const double t = x - left;
  const float* p = image.at(left, y) - 1;
  const auto a = static_cast<double>(p[0]), b = static_cast<double>(p[1]);
  const auto c = static_cast<double>(p[2]), d = static_cast<double>(p[3]);
  const double k1 = 0.5 * (c - a), k2 = a - 2.5 * b + 2.0 * c - 0.5 * d, k3 = 0.5 * (d - a) + 1.5 * (b - c);
  return {b + t * (k1 + t * (k2 + t * k3)), k1 + t * (2.0 * k2 + t * 3.0 * k3)};
}

// A finger in units of its middle's depth.
class Solid {
 public:
  Solid(const Tangent& tangent, const Fingertip& tip, double slope)
      : middle_(tangent.ray({tip.column, tip.row})), mm_(middle_.squaredNorm()) {
    const double rim = tip.outline / tangent.focal();  // tangent of half the finger's visual angle
    rr_ = mm_ * rim * rim / (1.0 + rim * rim);
    axis_ = std::cos(slope) * (tip.along_x * tangent.right() + tip.along_y * tangent.down()) +
            std::sin(slope) * tangent.view();
    across_ = middle_ - middle_.dot(axis_) * axis_;
    capped_ = axis_.squaredNorm() > 0.5;
  }
  // 1 / depth at which the ray meets the finger; 0 if it does not, or too obliquely for one of the eyes.
  // `eye`: offset of the right eye to the right.
  [[nodiscard]] double nearness(const Vec3& ray, double eye) const {
    const double b = ray.dot(middle_), rays = ray.squaredNorm(), root = b * b - rays * (mm_ - rr_);
    if (root >= 0.0) {
      const double depth = (b - std::sqrt(root)) / rays;
      const Vec3 out = depth * ray - middle_;
      if (!capped_ || out.dot(axis_) <= 0.0) return seen(depth * ray, out, eye) ? 1.0 / depth : 0.0;
    }
    return capped_ ? on_side(ray, eye) : 0.0;
  }

 private:
  [[nodiscard]] double on_side(const Vec3& ray, double eye) const {
    const Vec3 flat = ray - ray.dot(axis_) * axis_;
    const double b = flat.dot(across_), rays = flat.squaredNorm();
    const double root = b * b - rays * (across_.squaredNorm() - rr_);
    if (root < 0.0) return 0.0;
    const double depth = (b - std::sqrt(root)) / rays;
    const Vec3 from = depth * ray - middle_;
    const double back = from.dot(axis_);
    if (back < 0.0 || back * back > kBehind * kBehind * rr_) return 0.0;
    return seen(depth * ray, from - back * axis_, eye) ? 1.0 / depth : 0.0;
  }
  [[nodiscard]] bool seen(const Vec3& at, const Vec3& out, double eye) const {
    const Vec3 other = at - Vec3(eye, 0, 0);
    const double left = -out.dot(at), right = -out.dot(other), least = kAslant * kAslant * rr_;
    return left > 0.0 && right > 0.0 && left * left > least * at.squaredNorm() &&
           right * right > least * other.squaredNorm();
  }
  Vec3 middle_, axis_, across_;
  double mm_, rr_;
  bool capped_;
};

struct Spot {
  int x = 0, y = 0;
  double nearness = 0.0, by_slope = 0.0;
};

struct Sums {
  double n = 0.0;
  Mat3 normal = Mat3::Zero();  // rows: brightness, disparity, slope
  Vec3 right = Vec3::Zero();
  double squares = 0.0;
  [[nodiscard]] double left_over() const { return squares - right[0] * right[0] / n; }
};

// A finger of one slope, and a finger that is a little steeper.
class SlopePair {
 public:
  SlopePair(const Tangent& tangent, const Fingertip& tip, double disparity, double slope)
      : tangent_(tangent),
        solid_(tangent, tip, slope),
        steeper_(tangent, tip, slope + kLittle),
        eye_(disparity / tangent.focal()) {}
  // False if the pixel is not visible.
  [[nodiscard]] bool lay(Spot& spot) const {
    const Vec3 ray = tangent_.ray({static_cast<double>(spot.x), static_cast<double>(spot.y)});
    spot.nearness = solid_.nearness(ray, eye_);
    const double next = steeper_.nearness(ray, eye_);
    spot.by_slope = next > 0.0 ? (next - spot.nearness) / kLittle : 0.0;
    return spot.nearness > 0.0;
  }

 private:
  const Tangent& tangent_;
  Solid solid_, steeper_;
  double eye_;
};

// The cap and the part of the finger behind it that is compared.
Region part_of(const Fingertip& tip, const Region& image) {
  const double far = 1.2 * tip.outline * (1.0 + kBehind);
  return Region{static_cast<int>(tip.column - far), static_cast<int>(tip.row - far),
                static_cast<int>(tip.column + far) + 1, static_cast<int>(tip.row + far) + 1}
      .cut(image);
}

struct Views {
  SmoothGrey left, right;
};

// Cut-outs of both images around that part, for middle disparities from `least` to `most`.
Views views_of(const Grey& left, const Grey& right, const Fingertip& tip, double least, double most) {
  constexpr double kSlack = 1.1;  // covers nearer and farther parts of the finger
  constexpr int kCubic = 3;       // px: columns read on each side of a position
  const int passes =
      std::min(kMostPasses, static_cast<int>(2.0 * kSmooth * kSmooth * tip.outline * tip.outline));
  const Region own = part_of(tip, {0, 0, left.width, left.height});
  const Region other{own.x0 - static_cast<int>(kSlack * most) - kCubic, own.y0,
                     own.x1 - static_cast<int>(least / kSlack) + kCubic, own.y1};
  return {SmoothGrey(left, own, passes), SmoothGrey(right, other, passes)};
}

class Comparison {
 public:
  Comparison(const Grey& left, const Grey& right, const Views& views, const Mask& skin, const Fingertip& tip,
             const RectifiedPair& pair, std::size_t most)
      : left_(left),
        right_(right),
        views_(views),
        skin_(skin),
        tip_(tip),
        tangent_(pair, {tip.column, tip.row}),
        part_(part_of(tip, skin.whole())) {
    const double pixels = tip.outline * tip.outline * (1.6 + 2.0 * kBehind);
    step_ = static_cast<int>(std::ceil(std::sqrt(pixels / static_cast<double>(most))));
  }

  // Selects the pixels to compare for this slope; both eyes must see them.
  void choose(double disparity, double slope) {
    const SlopePair bent(tangent_, tip_, disparity, slope);
    count_ = 0;
    for (int y = part_.y0; y < part_.y1; y += step_)
      for (int x = part_.x0; x < part_.x1; x += step_)
        if (skin_.at(x, y) && count_ < kMost && bent.lay(spots_[count_] = {x, y})) ++count_;
  }
  // Keeps the selected pixels at another slope, except those that are not visible there.
  void bend(double disparity, double slope) {
    const SlopePair bent(tangent_, tip_, disparity, slope);
    const auto kept = std::remove_if(spots_.begin(), end(), [&](Spot& spot) { return !bent.lay(spot); });
    count_ = static_cast<std::size_t>(kept - spots_.begin());
  }
  // Drops pixels that differ much more than the rest: a reflection, a speck, something in front of the
  // finger.
  void drop_odd(double disparity, const Sums& sums) {
    constexpr double kOdd = 3.5, kLeast = 3.0;  // times the rms of all; grey levels
    const double most = std::max(kOdd * std::sqrt(sums.left_over() / sums.n), kLeast);
    const double usual = sums.right[0] / sums.n;
    const auto kept = std::remove_if(spots_.begin(), end(), [&](const Spot& spot) {
      const Residue residue = at(spot, disparity);
      return residue.seen && std::abs(residue.levels - usual) > most;
    });
    count_ = static_cast<std::size_t>(kept - spots_.begin());
  }
  // The brightness of both images may differ.
  [[nodiscard]] Sums at(double disparity) const {
    Sums sums;
    for (const Spot& spot : std::span(spots_.data(), count_)) {
      const auto [seen, residue, change] = at(spot, disparity);
      if (!seen) continue;
      const Vec3 slope(1.0, change * spot.nearness, change * disparity * spot.by_slope);
      ++sums.n;
      sums.normal += slope * slope.transpose();
      sums.right += slope * residue;
      sums.squares += residue * residue;
    }
    return sums;
  }

  // Difference of the right image just beyond the tip from the finger there, mean grey levels. It is small if
  // the finger continues there. So it separates positions along a finger whose skin looks alike.
  [[nodiscard]] double end(double disparity) const {
    const double beyond = tip_.outline + std::clamp(0.3 * tip_.outline, 2.0, 6.0);
    double sum = 0.0;
    int count = 0;
    for (int i = -7; i <= 7; ++i) {
      const double angle = 10.0 / 180.0 * M_PI * i, c = std::cos(angle), s = std::sin(angle);
      const double x = -tip_.along_x * c + tip_.along_y * s, y = -tip_.along_y * c - tip_.along_x * s;
      const Pixel out = tangent_.image({beyond * x, beyond * y});
      const Pixel in = tangent_.image({0.8 * tip_.outline * x, 0.8 * tip_.outline * y});
      const auto row = static_cast<int>(std::lround(out.row));
      const auto column = static_cast<int>(std::lround(out.column - disparity));
      const auto own_row = static_cast<int>(std::lround(in.row));
      const auto own_column = static_cast<int>(std::lround(in.column));
      if (!skin_.whole().contains(column, row) || !skin_.whole().contains(own_column, own_row)) continue;
      sum += std::abs(*right_.at(column, row) - *left_.at(own_column, own_row));
      ++count;
    }
    return count == 0 ? 0.0 : sum / count;
  }

 private:
  using Spots = std::array<Spot, kMost>;
  [[nodiscard]] Spots::iterator end() { return spots_.begin() + static_cast<std::ptrdiff_t>(count_); }
  struct Residue {
    bool seen = false;
    double levels = 0.0, slope = 0.0;  // grey levels; slope to the next pixel on the right
  };
  [[nodiscard]] Residue at(const Spot& spot, double disparity) const {
    const double column = spot.x - disparity * spot.nearness;
    const Region& part = views_.right.part();
    if (column < part.x0 + 1 || column >= part.x1 - 2) return {};
    const Level there = level_at(views_.right, column, spot.y);
    return {true, static_cast<double>(*views_.left.at(spot.x, spot.y)) - there.value, there.slope};
  }
  const Grey &left_, &right_;
  const Views& views_;
  const Mask& skin_;
  const Fingertip& tip_;
  Tangent tangent_;
  Region part_;
  int step_ = 1;
  Spots spots_;
  std::size_t count_ = 0;
};

struct Start {
  double left_over = kUnset;  // of a pixel
  double disparity = kUnset, slope = kUnset;
};

// Search range of the middle's disparity around that of a block. The block may be slightly off, and its
// position along a sloping finger is uncertain by half a radius.
double range_of(double disparity, double outline, double focal) {
  return kVague + 0.5 * disparity * outline / focal;
}

// The start with the least residual for a given slope, in steps of about half a pixel.
Start sought(Comparison& cap, double from, double range, double slope) {
  Start best;
  const int steps = static_cast<int>(std::ceil(2.0 * range));
  cap.choose(from, slope);
  for (int i = -steps; i <= steps; ++i) {
    const double disparity = from + range * i / steps;
    const Sums sums = cap.at(disparity);
    const double each = sums.left_over() / sums.n;
    if (sums.n >= kFewest && !(each >= best.left_over)) best = {each, disparity, slope};
  }
  return best;
}

// Newton's method with a prior of the slope. A range of 0 keeps the disparity.
CapDisparity settled(Comparison& cap, const Start& start, double range) {
  constexpr int kRounds = 12, kChoices = 4;
  constexpr double kKept = 1e-3;   // px: negligible
  constexpr double kExact = 0.05;  // grey levels^2: images without noise are not exact to the bit
  CapDisparity found{.disparity = start.disparity, .slope = start.slope};
  for (int round = 0; round < kRounds; ++round) {
    // Rim pixels that come and go with the slope must not keep the search from settling.
    if (round < kChoices)
      cap.choose(found.disparity, found.slope);
    else
      cap.bend(found.disparity, found.slope);
    Sums sums = cap.at(found.disparity);
    if (sums.n < kFewest) return {};
    cap.drop_odd(found.disparity, sums);
    sums = cap.at(found.disparity);
    if (sums.n < kFewest) return {};
    const double each = std::max(sums.left_over() / (sums.n - 3.0), kExact);
    const double known = each / (kSlopes * kSlopes);
    sums.normal(2, 2) += known;
    sums.right[2] += known * found.slope;
    if (range == 0.0) sums.normal(1, 1) += each / (kKept * kKept);
    const Mat3 inverse = sums.normal.inverse();
    const Vec3 step = -(inverse * sums.right);
    if (!step.allFinite()) return {};
    found.disparity += std::clamp(step[1], -0.7, 0.7);
    found.slope = std::clamp(found.slope + std::clamp(step[2], -0.3, 0.3), -kSteepest, kSteepest);
    found.left_over = each;
    found.variance = each * inverse(1, 1);
    found.good = std::abs(step[1]) < 0.05;
    if (std::abs(step[1]) < 0.005 && std::abs(step[2]) < 0.01) break;
  }
  found.good = found.good && std::abs(found.disparity - start.disparity) < std::max(range, 0.1);
  return found;
}

// True if the residual is smaller. If both are similar, the end of the finger decides.
bool better(const Comparison& cap, const CapDisparity& found, const CapDisparity& best) {
  constexpr double kAlike = 1.3, kApart = 2.0;  // px
  const bool alike = found.left_over < kAlike * best.left_over && best.left_over < kAlike * found.left_over;
  if (!alike || std::abs(found.disparity - best.disparity) < kApart)
    return !(found.left_over >= best.left_over);
  return cap.end(found.disparity) > cap.end(best.disparity);
}

}  // namespace

double front_of(double middle, double outline, double focal) {
  return middle * (1.0 + kFrontShare * outline / focal);
}

double middle_of(double surface, double outline, double focal) {
  return surface / (1.0 + kFrontShare * outline / focal);
}

CapDisparity match_cap(const Grey& left, const Grey& right, const Mask& skin, const Fingertip& tip,
                       const RectifiedPair& pair, std::span<const float> surfaces) {
  CapDisparity best;
  if (surfaces.empty()) return best;
  const auto [least, most] = std::minmax_element(surfaces.begin(), surfaces.end());
  const auto middle = [&](float surface) {
    return middle_of(static_cast<double>(surface), tip.outline, pair.focal);
  };
  const auto reach = [&](double from) { return range_of(from, tip.outline, pair.focal); };
  const Views views = views_of(left, right, tip, middle(*least) - reach(middle(*least)),
                               middle(*most) + reach(middle(*most)));
  Comparison few(left, right, views, skin, tip, pair, kFirst),
      all(left, right, views, skin, tip, pair, kMost);
  for (const float surface : surfaces) {
    const double from = middle(surface), range = reach(from);
    if (std::abs(from - best.disparity) < range) continue;  // found already
    for (const double slope : {0.0, -1.5 * kSlopes, 1.5 * kSlopes}) {
      const CapDisparity found = settled(all, sought(few, from, range, slope), range);
      if (found.good && better(all, found, best)) best = found;
    }
  }
  return best;
}

CapDisparity match_cap_at(const Grey& left, const Grey& right, const Mask& skin, const Fingertip& tip,
                          const RectifiedPair& pair, double disparity) {
  CapDisparity best;
  const Views views = views_of(left, right, tip, disparity, disparity);
  Comparison cap(left, right, views, skin, tip, pair, kMost);
  for (const double slope : {0.0, -1.5 * kSlopes, 1.5 * kSlopes}) {
    const CapDisparity found = settled(cap, {.disparity = disparity, .slope = slope}, 0.0);
    if (found.good && !(found.left_over >= best.left_over)) best = found;
  }
  return best;
}

}  // namespace enc
