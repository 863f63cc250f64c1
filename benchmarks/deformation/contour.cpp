#include "benchmarks/deformation/contour.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "benchmarks/verdict/reference.h"
#include "core/base/error.h"
#include "core/base/units.h"
#include "sim/bodies/ball_plant.h"

namespace enc::bench::deformation {
namespace {

constexpr double kSpacing = 0.05e-3;  // m, along a contour
constexpr double kColumn = 0.005e-3;  // m, sideways

// Evenly spaced over the visible half.
Contour spaced(const Contour& contour) {
  Contour points;
  double next = 0.0;  // on the segment
  for (std::size_t i = 0; i + 1 < contour.size(); ++i) {
    const Vec2 way = contour[i + 1] - contour[i];
    const double length = way.norm();
    while (next < length) {
      const Vec2 point = contour[i] + next / length * way;
      if (point[1] < 0.0) return points;
      points.push_back(point);
      next += kSpacing;
    }
    next -= length;
  }
  return points;
}

Vec2 nearest(const Contour& contour, const Vec2& p) {
  Vec2 best = contour.front();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < contour.size(); ++i) {
    const Vec2 way = contour[i + 1] - contour[i];
    const double share = std::clamp((p - contour[i]).dot(way) / way.squaredNorm(), 0.0, 1.0);
    const Vec2 point = contour[i] + share * way;
    const double away = (p - point).squaredNorm();
    if (away < least) least = away, best = point;
  }
  return best;
}

// Height over each column of the undeformed ball. Only outward steps count, so that a contour that folds back
// under itself is seen from above. Columns beyond the contour are not dented.
std::vector<double> dent_depths(const Contour& contour, double ball_radius) {
  const auto columns = static_cast<std::size_t>(ball_radius / kColumn);
  std::vector<double> depths(columns, 0.0);
  std::size_t column = 0;
  Vec2 from = contour.front();
  for (const Vec2& to : contour) {
    if (to[0] <= from[0]) {
      if (to[0] == from[0]) from = to;
      continue;
    }
    for (; column < columns; ++column) {
      const double r = (static_cast<double>(column) + 0.5) * kColumn;
      if (r > to[0]) break;
      const double z = from[1] + (r - from[0]) / (to[0] - from[0]) * (to[1] - from[1]);
      depths[column] = std::max(0.0, std::sqrt(ball_radius * ball_radius - r * r) - z);
    }
    from = to;
  }
  return depths;
}

constexpr const char* kFile = "fig11_contour.csv";

double probe_radius() { return sim::ball_set(sim::BallSet::nominal).probe_radius; }

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw Error(fmt::format("{}: {}; take the file of the repository anew", name, what));
}

// The rows of one contour, from the axis outwards to below the ball's middle, near the ball.
Contour contour_of(const Reference& table, const std::string& name, double tip_radius, double depth) {
  Contour contour;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (std::abs(table.number(row, "tip_radius_mm") - kMmPerM * tip_radius) > 1e-6 ||
        std::abs(table.number(row, "depth_mm") - kMmPerM * depth) > 1e-6)
      continue;
    contour.emplace_back(table.number(row, "r_mm") / kMmPerM, table.number(row, "z_mm") / kMmPerM);
    const Vec2& p = contour.back();
    if (!(p[0] >= 0.0 && p.norm() > 15e-3 && p.norm() < 50e-3))
      refuse(name, fmt::format("row {} is ({}, {}) mm; expected a point of a pressed ball of 33 mm", row + 1,
                               kMmPerM * p[0], kMmPerM * p[1]));
  }
  if (contour.size() < 50 || contour.front()[0] > 0.0 || contour.back()[1] > 0.0)
    refuse(name, fmt::format("the contour for {} mm under a tip of {} mm is not whole ({} points); expected "
                             "at least 50 from the axis to below the ball's middle",
                             kMmPerM * depth, kMmPerM * tip_radius, contour.size()));
  return contour;
}

Fig11Contours contours(const Reference& table, const std::string& name) {
  Fig11Contours found;
  for (const double depth : fig11_depths()) {
    found.probe.push_back(contour_of(table, name, probe_radius(), depth));
    found.stylus.push_back(contour_of(table, name, kStylus, depth));
  }
  return found;
}

}  // namespace

ContourGap contour_gap(const Contour& a, const Contour& b, double ball_radius) {
  const auto dented = [&](const Vec2& p) { return std::abs(p.norm() - ball_radius) > kDented; };
  ContourGap gap;
  double sum = 0.0;
  double sum_half = 0.0;
  std::size_t count = 0;
  std::size_t count_half = 0;
  const auto go = [&](const Contour& from, const Contour& to) {
    for (const Vec2& p : spaced(from)) {
      const Vec2 other = nearest(to, p);
      const double square = (p - other).squaredNorm();
      sum_half += square;
      ++count_half;
      if (!dented(p) && !dented(other)) continue;
      sum += square;
      ++count;
      gap.largest = std::max(gap.largest, std::sqrt(square));
    }
  };
  go(a, b);
  go(b, a);
  if (count > 0) gap.rms = std::sqrt(sum / static_cast<double>(count));
  if (count_half > 0) gap.half_rms = std::sqrt(sum_half / static_cast<double>(count_half));
  return gap;
}

GapProfile gap_along(const Contour& a, const Contour& b) {
  GapProfile gap;
  double length = 0.0;
  for (const Vec2& p : spaced(a)) {
    const Vec2 other = nearest(b, p);
    gap.length.push_back(length);
    gap.outside.push_back(std::copysign((other - p).norm(), other.norm() - p.norm()));
    length += kSpacing;
  }
  return gap;
}

Overlap overlap(const Contour& a, const Contour& b, double ball_radius) {
  const std::vector<double> in_a = dent_depths(a, ball_radius);
  const std::vector<double> in_b = dent_depths(b, ball_radius);
  double common = 0.0;
  double either = 0.0;
  double common_volume = 0.0;
  double either_volume = 0.0;
  for (std::size_t i = 0; i < in_a.size(); ++i) {
    const double r = static_cast<double>(i) + 0.5;
    common += std::min(in_a[i], in_b[i]);
    either += std::max(in_a[i], in_b[i]);
    common_volume += r * std::min(in_a[i], in_b[i]);
    either_volume += r * std::max(in_a[i], in_b[i]);
  }
  return {either > 0.0 ? common / either : 1.0, either > 0.0 ? common_volume / either_volume : 1.0};
}

const std::vector<double>& fig11_depths() {
  static const std::vector<double> kDepths{2e-3, 4e-3, 6e-3};
  return kDepths;
}

Fig11Contours load_fig11(const std::string& models) {
  return contours(Reference::load(models, kFile), kFile);
}
Fig11Contours parse_fig11(std::string_view text, const std::string& name) {
  return contours(Reference::parse(text, name), name);
}

}  // namespace enc::bench::deformation
