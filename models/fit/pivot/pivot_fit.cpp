#include "models/fit/pivot/pivot_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <fmt/format.h>

#include "core/error.h"
#include "models/order_statistics.h"

namespace enc::models {
namespace {

constexpr double kDeg = M_PI / 180.0;
constexpr double kShort = 0.25;                                   // s
constexpr std::array<double, 4> kLengths{kShort, 0.5, 1.0, 2.0};  // s, of blocks: the widest interval counts
constexpr std::size_t kFewestBlocks = 8;                          // of a length that counts
constexpr double kApart = 0.05;          // s: neighbours so far apart have errors of their own
constexpr double kStrong = 0.5;          // neighbours have to turn by so much of what the poses do
constexpr double kMedianLength = 1.538;  // of three normal numbers, over their standard deviation
constexpr double kFarthest = 6.0;        // standard deviations
constexpr double kSettled = 1e-6;        // m: good enough to begin with
constexpr double kNearest = 1e-9;        // m: what is nearer to the dimple is at it

// Sums over poses that are weighed with rotations (`by`): the poses' own, or their neighbours'.
struct Sums {
  double weight = 0.0;
  Mat3 by = Mat3::Zero(), turn = Mat3::Zero();  // means
  Vec3 place = Vec3::Zero();                    // mean
  Mat3 moment = Mat3::Zero();                   // of `by` with the turns, about their means
  Vec3 right = Vec3::Zero();                    // of `by` with the places, likewise
};

class PivotSolver {
 public:
  explicit PivotSolver(std::span<const PivotPose> poses) : poses_(poses) {
    turns_.reserve(poses.size());
    for (const PivotPose& pose : poses) turns_.push_back(pose.X_CT.q().normalized().toRotationMatrix());
    weights_.assign(poses.size(), 1.0);
    by_ = turns_;
  }

  PivotFit fit() {
    check_poses();
    check_swing();
    leave_out();
    check_stay();
    take_neighbours();
    solve();
    tell();
    return fit_;
  }

 private:
  std::size_t size() const { return poses_.size(); }
  Vec3 place(std::size_t i) const { return poses_[i].X_CT.p(); }
  Vec3 left_over(std::size_t i) const { return turns_[i] * tip_ + place(i) - dimple_; }

  Sums sums(const std::vector<Mat3>& by, const std::vector<double>& weights) const {
    Sums s;
    for (std::size_t i = 0; i < size(); ++i) {
      s.weight += weights[i];
      s.by += weights[i] * by[i];
      s.turn += weights[i] * turns_[i];
      s.place += weights[i] * place(i);
    }
    s.by /= s.weight, s.turn /= s.weight, s.place /= s.weight;
    for (std::size_t i = 0; i < size(); ++i) {
      const Mat3 arm = weights[i] / s.weight * (by[i] - s.by).transpose();
      s.moment += arm * (turns_[i] - s.turn);
      s.right += arm * (place(i) - s.place);
    }
    return s;
  }

  // The dimple drops out with the means. What is badly conditioned was refused, so moments do.
  Sums solve() {
    const Sums s = sums(by_, weights_);
    tip_ = s.moment.fullPivLu().solve(-s.right);
    dimple_ = s.turn * tip_ + s.place;
    return s;
  }

  void check_poses() const {
    if (size() < kFewestPoses)
      throw Error(fmt::format("there are {} poses of the tool; expected at least {}; record longer", size(),
                              kFewestPoses));
    for (std::size_t i = 0; i < size(); ++i)
      if (!poses_[i].X_CT.valid() || !std::isfinite(poses_[i].time) ||
          (i > 0 && !(poses_[i].time > poses_[i - 1].time)))
        throw Error(
            fmt::format("pose {} is none, or not later than the one before; expected finite numbers, a "
                        "unit quaternion and increasing times; leave it out",
                        i + 1));
    if (blocks(kLengths[1]).size() < kFewestBlocks)
      throw Error(fmt::format(
          "the poses of the tool are of {:.3g} s; expected at least {:g} s; record longer",
          poses_.back().time - poses_.front().time, static_cast<double>(kFewestBlocks) * kLengths[1]));
  }

  // A direction v of T turns by the root of v' moment v: for a rotation about one axis, this axis does not.
  void check_swing() {
    const Eigen::JacobiSVD<Mat3> along(sums(turns_, weights_).moment, Eigen::ComputeFullV);
    for (std::size_t k = 0; k < 3; ++k)
      fit_.swing[k] =
          std::asin(std::sqrt(std::min(1.0, along.singularValues()(static_cast<Eigen::Index>(2 - k)))));
    Vec3 least = along.matrixV().col(2);
    Eigen::Index largest = 0;
    least.cwiseAbs().maxCoeff(&largest);
    if (least(largest) < 0.0) least = -least;
    fit_.least_turned = Vec<'T'>(least);
    if (fit_.swing[0] >= kLeastSwing) return;
    if (fit_.swing[1] < kLeastSwing)
      throw Error(fmt::format(
          "the tool hardly turned: no direction of it by more than {:.2g} deg rms; expected at "
          "least {:g} deg of each; swing it about its tip by 20 deg or more to either side, about "
          "two axes",
          fit_.swing[2] / kDeg, kLeastSwing / kDeg));
    throw Error(fmt::format(
        "the tool turned about one axis alone, [{:.2f}, {:.2f}, {:.2f}] in T: this direction turned by "
        "{:.1f} deg rms, so the tip's place along it is not known; expected at least {:g} deg; swing the "
        "tool "
        "about a second axis as well, by 20 deg or more to either side",
        least.x(), least.y(), least.z(), fit_.swing[0] / kDeg, kLeastSwing / kDeg));
  }

  std::vector<double> distances() const {
    std::vector<double> all(size());
    for (std::size_t i = 0; i < size(); ++i) all[i] = left_over(i).norm();
    return all;
  }

  // First the least sum of distances, which a slip does not rule; then least squares of what is near.
  void leave_out() {
    solve();
    double moved = kUnset;
    for (int k = 0; k < 30 && !(moved < kSettled); ++k) {
      const std::vector<double> far = distances();
      for (std::size_t i = 0; i < size(); ++i) weights_[i] = 1.0 / std::max(far[i], kSettled);
      const Vec3 before = tip_;
      solve();
      moved = (tip_ - before).norm();
    }
    for (int k = 0; k < 20; ++k) {
      const std::vector<double> far = distances();
      const double limit = kFarthest * median(far) / kMedianLength;
      std::vector<double> near;
      near.reserve(far.size());
      for (const double x : far) near.push_back(x <= std::max(limit, kNearest) ? 1.0 : 0.0);
      if (near == weights_) break;
      weights_ = std::move(near);
      solve();
    }
    fit_.outliers = static_cast<std::size_t>(std::count(weights_.begin(), weights_.end(), 0.0));
  }

  void measure() {
    double squares = 0.0, count = 0.0;
    const std::vector<double> far = distances();
    fit_.most = 0.0;
    for (std::size_t i = 0; i < size(); ++i) {
      if (!(weights_[i] > 0.0)) continue;
      squares += far[i] * far[i];
      count += 1.0;
      fit_.most = std::max(fit_.most, far[i]);
    }
    fit_.rms = std::sqrt(squares / count);
    fit_.wander = 0.0;
    for (const auto& [from, to] : blocks(kShort)) {
      Vec3 middle;
      for (Eigen::Index a = 0; a < 3; ++a) {
        std::vector<double> along;
        for (std::size_t i = from; i < to; ++i) along.push_back(left_over(i)(a));
        middle(a) = median(along);
      }
      fit_.wander = std::max(fit_.wander, middle.norm());
    }
  }

  void check_stay() {
    measure();
    const double share = static_cast<double>(fit_.outliers) / static_cast<double>(size());
    if (fit_.rms <= kMostPivotRms && share <= kMostPivotOutliers) return;
    throw Error(fmt::format(
        "the tip did not stay: it wandered by up to {:.3g} mm, poses differ by {:.3g} mm rms, and {:.0f} % "
        "more lie apart; expected at most {:g} mm rms and {:.0f} %; hold the tip in its dimple, and see that "
        "the poses are of the markers in the tracker's frame",
        fit_.wander * 1e3, fit_.rms * 1e3, 100.0 * share, kMostPivotRms * 1e3, 100.0 * kMostPivotOutliers));
  }

  // Poses from `first` to before `second`, of so much time each.
  std::vector<std::pair<std::size_t, std::size_t>> blocks(double length) const {
    std::vector<std::pair<std::size_t, std::size_t>> all;
    double begin = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < size(); ++i) {
      if (poses_[i].time >= begin + length) {
        begin = poses_[i].time;
        all.emplace_back(i, i);
      }
      all.back().second = i + 1;
    }
    return all;
  }

  // The mean of a pose a little before and of one a little after; a pose that has neither does not count.
  void take_neighbours() {
    std::vector<double> steps;
    for (std::size_t i = 1; i < size(); ++i) steps.push_back(poses_[i].time - poses_[i - 1].time);
    const double wanted = std::ceil(kApart / std::max(median(steps), 1e-6));
    const std::size_t most = size() / 4;
    const auto lag = static_cast<std::size_t>(std::clamp(wanted, 1.0, static_cast<double>(most)));
    std::vector<Mat3> by(size(), Mat3::Zero());
    std::vector<double> weights(size(), 0.0);
    for (std::size_t i = 0; i < size(); ++i) {
      const bool before = i >= lag && weights_[i - lag] > 0.0;
      const bool after = i + lag < size() && weights_[i + lag] > 0.0;
      if (!before && !after) continue;
      by[i] = before && after ? Mat3(0.5 * (turns_[i - lag] + turns_[i + lag]))
                              : turns_[before ? i - lag : i + lag];
      weights[i] = weights_[i];
    }
    const auto least = [](const Sums& s) { return Eigen::JacobiSVD<Mat3>(s.moment).singularValues()(2); };
    if (!(least(sums(by, weights)) >= kStrong * least(sums(turns_, weights_)))) return;
    by_ = std::move(by);
    weights_ = std::move(weights);
  }

  // What each block of time did to the tip is known from what it left over.
  std::array<Interval, 3> intervals(const Sums& s, double length) const {
    const Mat3 inverse = s.moment.inverse() / s.weight;
    std::array<Blocks, 3> sides;
    for (const auto& [from, to] : blocks(length)) {
      Vec3 influence = Vec3::Zero(), weight = Vec3::Zero();
      for (std::size_t i = from; i < to; ++i) {
        const Mat3 arm = weights_[i] * inverse * (by_[i] - s.by).transpose();
        influence += arm * left_over(i);
        weight += arm.rowwise().squaredNorm();
      }
      for (std::size_t a = 0; a < 3; ++a) {
        sides[a].influence.push_back(influence(static_cast<Eigen::Index>(a)));
        sides[a].weight.push_back(weight(static_cast<Eigen::Index>(a)));
      }
    }
    return {sides[0].around(tip_.x()), sides[1].around(tip_.y()), sides[2].around(tip_.z())};
  }

  void tell() {
    const Sums s = sums(by_, weights_);
    for (const double length : kLengths) {
      if (blocks(length).size() < kFewestBlocks) continue;
      const std::array<Interval, 3> found = intervals(s, length);
      for (std::size_t a = 0; a < 3; ++a)
        fit_.tip[a] = {found[a].value, std::fmax(fit_.tip[a].half, found[a].half)};
    }
    fit_.dimple = Point<'C'>(dimple_);
    measure();
  }

  std::span<const PivotPose> poses_;
  std::vector<Mat3> turns_, by_;
  std::vector<double> weights_;
  Vec3 tip_ = Vec3::Zero(), dimple_ = Vec3::Zero();
  PivotFit fit_;
};

}  // namespace

PivotFit fit_pivot(std::span<const PivotPose> poses) { return PivotSolver(poses).fit(); }

}  // namespace enc::models
