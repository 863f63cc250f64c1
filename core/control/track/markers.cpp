#include "core/control/track/markers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <Eigen/SVD>

namespace enc {
namespace {

// An assignment of seen points to a tool's markers: the marker's index for each seen point.
using Order = std::array<std::size_t, kMostMarkers>;

struct RigidFit {
  Pose<'C', 'T'> X_CT;
  double rms = std::numeric_limits<double>::infinity();
};

// The rigid motion that best fits the markers to the seen points: least squares, by the singular values of
// their product [Arun 1987; Umeyama 1991].
RigidFit fitted_motion(std::span<const Vec3> seen, std::span<const Vec3> markers, const Order& order) {
  const auto count = static_cast<double>(seen.size());
  Vec3 middle_C = Vec3::Zero(), middle_T = Vec3::Zero();
  for (std::size_t i = 0; i < seen.size(); ++i) {
    middle_C += seen[i] / count;
    middle_T += markers[order[i]] / count;
  }
  Mat3 product = Mat3::Zero();
  for (std::size_t i = 0; i < seen.size(); ++i)
    product += (seen[i] - middle_C) * (markers[order[i]] - middle_T).transpose();
  const Eigen::JacobiSVD<Mat3> svd(product, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 hand(1, 1, 1);
  hand.z() = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const Mat3 turn = svd.matrixU() * hand.asDiagonal() * svd.matrixV().transpose();
  double squares = 0.0;
  for (std::size_t i = 0; i < seen.size(); ++i)
    squares += (turn * (markers[order[i]] - middle_T) - (seen[i] - middle_C)).squaredNorm();
  return {{Quat(turn).normalized(), Vec3(middle_C - turn * middle_T)}, std::sqrt(squares / count)};
}

// Passes each order in which all distances agree to `judge`, until that returns false.
template <class Judge>
class Orders {
 public:
  Orders(std::span<const Vec3> seen, std::span<const Vec3> markers, Judge judge)
      : seen_(seen), markers_(markers), judge_(judge) {
    if (seen.size() == markers.size() && seen.size() <= kMostMarkers) go_on(0);
  }

 private:
  bool go_on(std::size_t i) {
    if (i == seen_.size()) return judge_(order_);
    if (++ways_ > kMostWays) return false;
    for (std::size_t marker = 0; marker < markers_.size(); ++marker) {
      if (taken_[marker] || !agrees(i, marker)) continue;
      taken_[marker] = true;
      order_[i] = marker;
      const bool more = go_on(i + 1);
      taken_[marker] = false;
      if (!more) return false;
    }
    return true;
  }
  [[nodiscard]] bool agrees(std::size_t i, std::size_t marker) const {
    for (std::size_t j = 0; j < i; ++j) {
      const double seen = (seen_[i] - seen_[j]).norm(), own = (markers_[marker] - markers_[order_[j]]).norm();
      if (!(std::abs(seen - own) < kMarkersApart)) return false;
    }
    return true;
  }

  // Limit on attempted orders. Markers of a tool whose distances all differ need some hundred.
  static constexpr int kMostWays = 100'000;
  int ways_ = 0;
  std::span<const Vec3> seen_, markers_;
  Judge judge_;
  Order order_{};
  std::array<bool, kMostMarkers> taken_{};
};

}  // namespace

RecognisedTool recognise(std::span<const Vec3> seen, std::span<const std::vector<Vec3>> tools) {
  RecognisedTool best;
  RigidFit closest;
  for (std::size_t i = 0; i < tools.size(); ++i)
    Orders(seen, tools[i], [&](const Order& order) {
      const RigidFit fit = fitted_motion(seen, tools[i], order);
      if (fit.rms <= kWorstFit && fit.rms < closest.rms) {
        closest = fit;
        best = {static_cast<std::int32_t>(i), fit.X_CT, fit.rms};
      }
      return true;
    });
  return best;
}

Vec3 middle_of(std::span<const Vec3> markers) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& marker : markers) middle += marker / static_cast<double>(markers.size());
  return middle;
}

Mat3 point_covariance(std::span<const Vec3> markers, const Vec3& point) {
  const Vec3 middle = middle_of(markers);
  Mat3 turning = Mat3::Zero();  // the inverse of the covariance of a small turn
  for (const Vec3& marker : markers) {
    const Vec3 arm = marker - middle;
    turning += arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose();
  }
  const Vec3 lever = point - middle;
  Mat3 cross;
  cross << 0, -lever.z(), lever.y(), lever.z(), 0, -lever.x(), -lever.y(), lever.x(), 0;
  return Mat3::Identity() / static_cast<double>(markers.size()) +
         cross * turning.inverse() * cross.transpose();
}

bool alike(std::span<const Vec3> markers, std::span<const Vec3> other) {
  bool any = false;
  Orders(markers, other, [&any](const Order&) {
    any = true;
    return false;
  });
  return any;
}

bool has_two_poses(std::span<const Vec3> markers) {
  int ways = 0;
  Orders(markers, markers, [&ways](const Order&) { return ++ways < 2; });
  return ways > 1;
}

}  // namespace enc
