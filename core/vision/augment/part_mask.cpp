#include "core/vision/augment/part_mask.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/vision/stereo/triangulate.h"

namespace enc::augment {
namespace {

constexpr int kAround = 24;  // points of a circle: what it loses is below 1 % of its radius

double cross(const Pixel& o, const Pixel& a, const Pixel& b) {
  return (a.column - o.column) * (b.row - o.row) - (a.row - o.row) * (b.column - o.column);
}

// Convex, in order. Andrew's chain.
std::vector<Pixel> hull(std::vector<Pixel> points) {
  if (points.size() < 3) return {};
  std::sort(points.begin(), points.end(), [](const Pixel& a, const Pixel& b) {
    return a.column < b.column || (a.column == b.column && a.row < b.row);
  });
  std::vector<Pixel> out;
  const auto take = [&](const Pixel& p, std::size_t least) {
    while (out.size() >= least + 2 && cross(out[out.size() - 2], out.back(), p) <= 0.0) out.pop_back();
    out.push_back(p);
  };
  for (const Pixel& p : points) take(p, 0);
  const std::size_t lower = out.size() - 1;
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) take(*p, lower);
  out.pop_back();
  return out;
}

std::vector<Pixel> grown(const std::vector<Pixel>& polygon, double margin) {
  std::vector<Pixel> points;
  const double out = margin / std::cos(M_PI / kAround);  // the polygon round the circle, not in it
  for (const Pixel& p : polygon)
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2.0 * M_PI * i / kAround;
      points.push_back({p.column + out * std::cos(angle), p.row + out * std::sin(angle)});
    }
  return hull(std::move(points));
}

void fill(const std::vector<Pixel>& polygon, Mask& mask) {
  if (polygon.empty()) return;
  const auto by_row = [](const Pixel& a, const Pixel& b) { return a.row < b.row; };
  const auto [top, bottom] = std::minmax_element(polygon.begin(), polygon.end(), by_row);
  const int last = static_cast<int>(std::floor(std::min(bottom->row, mask.height - 1.0)));
  for (int y = static_cast<int>(std::ceil(std::max(0.0, top->row))); y <= last; ++y) {
    double from = mask.width, to = -1.0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Pixel &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      if ((a.row > y) == (b.row > y)) continue;
      const double x = a.column + (y - a.row) / (b.row - a.row) * (b.column - a.column);
      from = std::min(from, x);
      to = std::max(to, x);
    }
    const int x0 = static_cast<int>(std::ceil(std::max(0.0, from)));
    const int x1 = static_cast<int>(std::floor(std::min(to, mask.width - 1.0)));
    if (x0 <= x1) std::fill(mask.row(y) + x0, mask.row(y) + x1 + 1, std::uint8_t{255});
  }
}

// Points whose hull the part is, and of a ball those in which rays from the camera touch it; in C.
std::vector<Vec3> corners(const ArmPart& part, const Pose<'C', 'W'>& X_CW) {
  const Vec3 middle = (X_CW * part.middle).e();
  const Mat3 axes = X_CW.q().toRotationMatrix() * part.axes;
  std::vector<Vec3> points;
  if (part.form == PartForm::box) {
    for (int i = 0; i < 8; ++i) {
      const Vec3 sign((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
      points.emplace_back(middle + axes * sign.cwiseProduct(part.half));
    }
    return points;
  }
  const auto circle = [&](const Vec3& at, const Vec3& a, const Vec3& b) {
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2.0 * M_PI * i / kAround;
      points.emplace_back(at + std::cos(angle) * a + std::sin(angle) * b);
    }
  };
  const double radius = part.half.x();
  for (const double end : {-1.0, 1.0}) {
    const Vec3 at = middle + end * part.half.z() * axes.col(2);
    if (part.form == PartForm::cylinder) {
      circle(at, radius * axes.col(0), radius * axes.col(1));
      continue;
    }
    const double share = radius * radius / at.squaredNorm();
    if (share >= 1.0) continue;  // the camera is in it
    const Vec3 a = at.unitOrthogonal(), b = at.normalized().cross(a);
    const double rim = radius * std::sqrt(1.0 - share);
    circle((1.0 - share) * at, rim * a, rim * b);
  }
  return points;
}

}  // namespace

void cover(const RectifiedPair& pair, const Pose<'C', 'W'>& X_CW, const ArmPart& part, double margin,
           Mask& mask) {
  std::vector<Pixel> seen;
  for (const Vec3& corner : corners(part, X_CW)) {
    const Triplet at = seen_at(pair, Point<'C'>(corner));
    if (at.disparity > 0.0) seen.push_back({at.column, at.row});
  }
  fill(grown(hull(std::move(seen)), margin), mask);
}

}  // namespace enc::augment
