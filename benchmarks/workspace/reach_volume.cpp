#include "benchmarks/workspace/reach_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "benchmarks/kit/parallel.h"
#include "core/base/rotation.h"

namespace enc::bench::workspace {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kHalf = 0.12;  // m: of the searched box, larger than the travel of any such machine

// Largest f over (-kHalf, kHalf) in two numbers: a grid, then ever shorter steps.
double largest(const std::function<double(double, double)>& f) {
  constexpr double kGrid = 4e-3;
  double best = -kNever, bx = 0.0, by = 0.0;
  const auto look = [&](double x, double y) {
    const double value = f(x, y);
    if (!(value > best)) return false;
    best = value, bx = x, by = y;
    return true;
  };
  constexpr int kCells = static_cast<int>(kHalf / kGrid);  // to either side
  for (int i = -kCells; i <= kCells; ++i)
    for (int j = -kCells; j <= kCells; ++j) look(i * kGrid, j * kGrid);
  for (double step = kGrid / 2; step > 1e-8;) {
    const double x = bx, y = by;
    bool better = false;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j) better = look(x + i * step, y + j * step) || better;
    if (!better) step /= 2;
  }
  return best;
}

}  // namespace

ReachVolume::Column ReachVolume::column(double x, double y) const {
  const HexapodGeometry& g = machine_.geometry();
  const double shortest = machine_.zero_length() - g.stroke, longest = machine_.zero_length() + g.stroke;
  const double zero = g.height + g.tip_height;  // height of H over the base joints
  Column out{-kNever, kNever};
  for (int leg = 0; leg < 6; ++leg) {
    const Vec3 arm = machine_.platform_joint(leg) - machine_.base_joint(leg);
    const double beside = (x + arm.x()) * (x + arm.x()) + (y + arm.y()) * (y + arm.y());
    if (beside > longest * longest) return {0.0, -kNever};
    out.high = std::min(out.high, std::sqrt(longest * longest - beside) - arm.z() - zero);
    out.low = std::max(out.low, std::sqrt(std::max(0.0, shortest * shortest - beside)) - arm.z() - zero);
  }
  return out;
}

double ReachVolume::straight(double step) const {
  const auto n = static_cast<int>(std::ceil(2.0 * kHalf / step));
  double sum = 0.0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) sum += column(-kHalf + (i + 0.5) * step, -kHalf + (j + 0.5) * step).height();
  return sum * step * step;
}

ReachVolume::Extents ReachVolume::extents() const {
  Extents out;
  // Extent to a side: the largest x where some y still has a height.
  const auto side = [&](bool along_x, double sign) {
    double in = 0.0, outside = kHalf;
    const auto open = [&](double at) {
      constexpr double kFine = 0.25e-3;  // m
      constexpr int kCells = static_cast<int>(kHalf / kFine);
      for (int i = -kCells; i <= kCells; ++i) {
        const double other = i * kFine;
        const Column c = along_x ? column(sign * at, other) : column(other, sign * at);
        if (c.high >= c.low) return true;
      }
      return false;
    };
    while (outside - in > 1e-7) {
      const double middle = 0.5 * (in + outside);
      (open(middle) ? in : outside) = middle;
    }
    return sign * in;
  };
  const auto height = [&](double sign) {
    return sign * largest([&](double x, double y) {
             const Column c = column(x, y);
             return c.high >= c.low ? (sign > 0.0 ? c.high : -c.low) : -kNever;
           });
  };
  out.low = {side(true, -1.0), side(false, -1.0), height(-1.0)};
  out.high = {side(true, 1.0), side(false, 1.0), height(1.0)};
  return out;
}

double ReachVolume::slack(const Vec3& p, const Vec3& turn) const {
  const HexapodGeometry& g = machine_.geometry();
  const Pose<'R', 'H'> X_RH(rotation_xyz(turn), Vec3(p + machine_.zero().p()));
  const ReachLimit limit = machine_.limit(X_RH);
  if (limit == ReachLimit::tilt || limit == ReachLimit::yaw) return -kNever;
  const double worst = (machine_.inverse(X_RH).array() - machine_.zero_length()).abs().maxCoeff();
  // limit() reports stroke before tilt and yaw, so those must be checked as well.
  const Mat3 R = X_RH.q().toRotationMatrix();
  const bool allowed =
      R(2, 2) >= std::cos(g.tilt_limit) && std::abs(std::atan2(R(1, 0), R(0, 0))) <= g.yaw_limit;
  return allowed ? g.stroke - worst : -kNever;
}

double ReachVolume::turned_slack(const Vec3& p) const {
  static constexpr double kTilt = 0.15;  // rad
  static const std::array<Vec3, 5> kStarts{Vec3(0, 0, 0), Vec3(kTilt, 0, 0), Vec3(-kTilt, 0, 0),
                                           Vec3(0, kTilt, 0), Vec3(0, -kTilt, 0)};
  double best = -kNever;
  for (const Vec3& start : kStarts) {
    Vec3 at = start;
    double here = slack(p, at);
    for (double step = 0.08; step > 1e-3 && here < 0.0;) {
      const Vec3 from = at;
      for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
          const Vec3 to = from + sign * step * Vec3::Unit(axis);
          const double there = slack(p, to);
          if (there > here) here = there, at = to;
        }
      if (at == from) step /= 2;
    }
    best = std::max(best, here);
    if (best >= 0.0) break;
  }
  return best;
}

double ReachVolume::turned_height(double x, double y) const {
  constexpr double kDeep = 0.06, kLayer = 0.01, kExact = 0.1e-3;  // m
  const auto reached = [&](double z) { return turned_slack({x, y, z}) >= 0.0; };
  double low = kNever, high = -kNever;
  constexpr int kLayers = static_cast<int>(kDeep / kLayer + 0.5);
  for (int i = -kLayers; i <= kLayers; ++i)
    if (const double z = i * kLayer; reached(z)) low = std::min(low, z), high = std::max(high, z);
  if (low > high) return 0.0;
  const auto edge = [&](double in, double outside) {
    while (std::abs(outside - in) > kExact)
      (reached(0.5 * (in + outside)) ? in : outside) = 0.5 * (in + outside);
    return in;
  };
  return edge(high, high + kLayer) - edge(low, low - kLayer);
}

double ReachVolume::turned(double step) const {
  const auto n = static_cast<std::size_t>(std::ceil(2.0 * kHalf / step));
  std::vector<double> rows(n, 0.0);
  const auto place = [&](std::size_t i) { return -kHalf + (static_cast<double>(i) + 0.5) * step; };
  in_parallel(n, [&](std::size_t i) {
    for (std::size_t j = 0; j < n; ++j) rows[i] += turned_height(place(i), place(j));
  });
  double sum = 0.0;
  for (const double row : rows) sum += row;
  return sum * step * step;
}

}  // namespace enc::bench::workspace
