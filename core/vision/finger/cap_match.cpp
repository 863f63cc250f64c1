#include "core/vision/finger/cap_match.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/vision/finger/tangent.h"
#include "core/vision/stereo/smoothed.h"

namespace enc {
namespace {

constexpr double kFrontShare = 0.9;  // of the cap's radius, by which a block is nearer than the middle
constexpr double kVague = 1.0;       // px, by which a block may be off
constexpr int kFewest = 16;          // pixels
constexpr std::size_t kMost = 512;   // pixels that are compared, evenly spread
constexpr std::size_t kFirst = 256;  // at first
constexpr double kBehind = 1.0;      // radii of the finger behind the cap that count
// Cosine of 60 degrees: what is seen more aslant lies within a seventh of a radius of the rim, where a pixel
// has some of the background, in the other image as well.
constexpr double kAslant = 0.5;
constexpr double kSlopes = 0.3;    // rad rms, of fingers against the image
constexpr double kSteepest = 1.2;  // rad
constexpr double kLittle = 1e-3;   // rad, for the derivative
// Of a cap's radius: how far each pixel is smoothed (rms), so that of dark skin seen from near more is left
// than noise. Twice as far mixes in what is beyond the rim.
constexpr double kSmooth = 1.0 / 18.0;
constexpr int kMostPasses = 8;  // px

// A grey level between two columns: the cubic through four [Catmull and Rom], and its slope.
struct Level {
  double value, slope;
};
Level level_at(const Smoothed& image, double x, int y) {
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
    const double rim = tip.outline / tangent.focal();  // tangent of the half angle under which it is seen
    rr_ = mm_ * rim * rim / (1.0 + rim * rim);
    axis_ = std::cos(slope) * (tip.along_x * tangent.right() + tip.along_y * tangent.down()) +
            std::sin(slope) * tangent.view();
    across_ = middle_ - middle_.dot(axis_) * axis_;
    capped_ = axis_.squaredNorm() > 0.5;
  }
  // One over the depth at which the ray meets it, 0 where it does not, or too aslant for one of the eyes;
  // `eye` is how far the right one is to the right.
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
  Mat3 normal = Mat3::Zero();  // of brightness, disparity, slope
  Vec3 right = Vec3::Zero();
  double squares = 0.0;
  [[nodiscard]] double left_over() const { return squares - right[0] * right[0] / n; }
};

// A finger of one slope, and of one a little steeper.
class Bent {
 public:
  Bent(const Tangent& tangent, const Fingertip& tip, double disparity, double slope)
      : tangent_(tangent),
        solid_(tangent, tip, slope),
        steeper_(tangent, tip, slope + kLittle),
        eye_(disparity / tangent.focal()) {}
  // False where it is out of sight.
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

// The cap and what counts of the finger behind it.
Region part_of(const Fingertip& tip, const Region& image) {
  const double far = 1.2 * tip.outline * (1.0 + kBehind);
  return Region{static_cast<int>(tip.column - far), static_cast<int>(tip.row - far),
                static_cast<int>(tip.column + far) + 1, static_cast<int>(tip.row + far) + 1}
      .cut(image);
}

struct Views {
  Smoothed left, right;
};

// Both images of it, where its middle has one of these disparities.
Views views_of(const Grey& left, const Grey& right, const Fingertip& tip, double least, double most) {
  constexpr double kSlack = 1.1;  // nearer and farther parts of the finger
  constexpr int kCubic = 3;       // px: columns round a place that are read
  const int passes =
      std::min(kMostPasses, static_cast<int>(2.0 * kSmooth * kSmooth * tip.outline * tip.outline));
  const Region own = part_of(tip, {0, 0, left.width, left.height});
  const Region other{own.x0 - static_cast<int>(kSlack * most) - kCubic, own.y0,
                     own.x1 - static_cast<int>(least / kSlack) + kCubic, own.y1};
  return {Smoothed(left, own, passes), Smoothed(right, other, passes)};
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

  // The pixels that are compared, were the finger's slope this one; both eyes see them.
  void choose(double disparity, double slope) {
    const Bent bent(tangent_, tip_, disparity, slope);
    count_ = 0;
    for (int y = part_.y0; y < part_.y1; y += step_)
      for (int x = part_.x0; x < part_.x1; x += step_)
        if (skin_.at(x, y) && count_ < kMost && bent.lay(spots_[count_] = {x, y})) ++count_;
  }
  // The same ones at another slope, without those that are out of sight then.
  void bend(double disparity, double slope) {
    const Bent bent(tangent_, tip_, disparity, slope);
    const auto kept = std::remove_if(spots_.begin(), end(), [&](Spot& spot) { return !bent.lay(spot); });
    count_ = static_cast<std::size_t>(kept - spots_.begin());
  }
  // Those that differ by much more than the others: a reflection, a speck, what is before the finger.
  void drop_odd(double disparity, const Sums& sums) {
    constexpr double kOdd = 3.5, kLeast = 3.0;  // rms of all, grey levels
    const double most = std::max(kOdd * std::sqrt(sums.left_over() / sums.n), kLeast);
    const double usual = sums.right[0] / sums.n;
    const auto kept = std::remove_if(spots_.begin(), end(), [&](const Spot& spot) {
      const Residue residue = at(spot, disparity);
      return residue.seen && std::abs(residue.levels - usual) > most;
    });
    count_ = static_cast<std::size_t>(kept - spots_.begin());
  }
  // The brightness of the images may differ.
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

  // How much the right image differs, just beyond the tip, from the finger there, mean grey levels: little,
  // where the finger goes on. It tells places along a finger apart whose skin is alike.
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
    double levels = 0.0, slope = 0.0;  // grey levels, those of a pixel to the right
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

// How far the middle's disparity may be from what a block tells: the block is a little off, and where on the
// sloping finger it is hardly matters to the half of its radius.
double range_of(double disparity, double outline, double focal) {
  return kVague + 0.5 * disparity * outline / focal;
}

// The least that is left over at a slope, in steps of about half a pixel.
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

// Newton, with what is known of slopes beforehand. A range of 0 keeps the disparity.
CapDisparity settled(Comparison& cap, const Start& start, double range) {
  constexpr int kRounds = 12, kChoices = 4;
  constexpr double kKept = 1e-3;   // px: of no account
  constexpr double kExact = 0.05;  // grey levels^2: pictures without noise are not exact to the bit
  CapDisparity found{.disparity = start.disparity, .slope = start.slope};
  for (int round = 0; round < kRounds; ++round) {
    // Pixels at the rim that come and go with the slope must not keep it from settling.
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

// Less is left over; where about as much is, the end of the finger decides.
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
