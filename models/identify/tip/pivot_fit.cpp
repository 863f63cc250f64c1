#include "models/identify/tip/pivot_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/base/words.h"
#include "models/order_statistics.h"

namespace enc::models {
namespace {

constexpr double kShort = 0.25;  // s
// s, lengths of blocks: the widest interval counts
constexpr std::array<double, 4> kLengths{kShort, 0.5, 1.0, 2.0};
constexpr double kFewestBlocks = 2.0;    // fewest blocks of a length that counts: freedom of Student's t
constexpr double kGap = 0.5;             // s, and 4 usual steps: more than both is a gap
constexpr double kSame = 2.0 * kDegree;  // the tool rests while it stays this close to its first pose
constexpr double kLongStand = 1.0;       // s, least duration of a rest
constexpr double kApart = 0.05;          // s: neighbours this far apart have independent errors
constexpr double kStrong = 0.5;          // least rotation of neighbours as a share of the poses' own
constexpr double kMedianLength = 1.538;  // median length of a normal 3-vector, in sigmas
constexpr double kFarthest = 6.0;        // standard deviations
constexpr double kSettled = 1e-6;        // m: accurate enough to start from
constexpr double kNearest = 1e-9;        // m: a tip this close to the dimple is at it

// Sums over poses, weighted with rotations (`by`): the poses' own, or their neighbours'.
struct Sums {
  double weight = 0.0;
  Mat3 by = Mat3::Zero(), turn = Mat3::Zero();  // means
  Vec3 place = Vec3::Zero();                    // mean
  Mat3 moment = Mat3::Zero();                   // `by` with the rotations, about their means
  Vec3 right = Vec3::Zero();                    // sums of `by` with the positions
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
    find_rests();
    check_time();
    check_swing();
    check_motion(0.0);
    leave_out();
    check_stay();
    check_swing();  // the remaining poses may rotate about one axis only
    take_neighbours();
    check_swing();
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

  // Subtracting the means removes the dimple. A badly conditioned log was refused before, so moments suffice.
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
  }

  void find_rests() {
    rests_.assign(size(), false);
    for (std::size_t from = 0, i = 1; i <= size(); ++i) {
      if (i < size() && poses_[i].X_CT.q().angularDistance(poses_[from].X_CT.q()) <= kSame) continue;
      if (poses_[i - 1].time - poses_[from].time >= kLongStand) {
        std::fill(rests_.begin() + static_cast<std::ptrdiff_t>(from),
                  rests_.begin() + static_cast<std::ptrdiff_t>(i), true);
        ++stands_;
      }
      from = i;
    }
  }

  // A gap or a rest gives no information about the tip, however long it is. A rest counts as one short block.
  void check_time() {
    if (const std::string doubt = doubt_of_time(poses_); !doubt.empty())
      throw Error(
          fmt::format("{} so slow a motion does not tell the tip; expected a swing of {:g} s or more; give "
                      "time_s in seconds",
                      doubt, kLeastPivotTime));
    const double gap = std::max(kGap, 4.0 * usual_step());
    double gaps = 0.0;
    for (std::size_t i = 1; i < size(); ++i) {
      const double step = poses_[i].time - poses_[i - 1].time;
      (step > gap ? gaps : rests_[i] && rests_[i - 1] ? fit_.rested : fit_.turned) += step;
    }
    const double all = fit_.turned + fit_.rested;
    if (all < kLeastPivotTime && gaps > 0.0)
      throw Error(fmt::format(
          "the poses of the tool are of {:.3g} s, without the gaps in them, which are {:.3g} s; expected at "
          "least {:g} s of poses; record longer, with the markers in view",
          all, gaps, kLeastPivotTime));
    if (all < kLeastPivotTime)
      throw Error(
          fmt::format("the poses of the tool are of {:.3g} s; expected at least {:g} s; record longer", all,
                      kLeastPivotTime));
    check_motion(kLongStand);  // check_swing() reports a tool that never rotated
  }

  // Checks logs in which the tool rotated for at least this time.
  void check_motion(double least) const {
    if (fit_.turned < least || fit_.turned + static_cast<double>(stands_) * kShort >= kLeastPivotTime) return;
    throw Error(
        fmt::format("the tool rested for most of the log: it turned for {:.3g} s of {:.3g} s; expected at "
                    "least {:g} s; swing it about its tip for longer",
                    fit_.turned, fit_.turned + fit_.rested, kLeastPivotTime));
  }

  double usual_step() const {
    std::vector<double> steps;
    for (std::size_t i = 1; i < size(); ++i) steps.push_back(poses_[i].time - poses_[i - 1].time);
    return median(steps);
  }

  // A direction v of T rotates by the root of v' moment v: a rotation about one axis leaves that axis in
  // place.
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
    const std::string without =
        fit_.outliers > 0
            ? fmt::format(", without the {} poses that lie apart and are left out", fit_.outliers)
            : "";
    if (fit_.swing[1] < kLeastSwing)
      throw Error(fmt::format(
          "the tool hardly turned{}: no direction of it by more than {:.2g} deg rms; expected at "
          "least {:g} deg of each; swing it about its tip by 20 deg or more to either side, about "
          "two axes{}",
          without, fit_.swing[2] / kDegree, kLeastSwing / kDegree, kept_in(without)));
    throw Error(fmt::format(
        "the tool turned about one axis alone, [{:.2f}, {:.2f}, {:.2f}] in T{}: this direction turned by "
        "{:.1f} deg rms, so the tip's place along it is not known; expected at least {:g} deg; swing the "
        "tool about a second axis as well, by 20 deg or more to either side{}",
        least.x(), least.y(), least.z(), without, fit_.swing[0] / kDegree, kLeastSwing / kDegree,
        kept_in(without)));
  }
  static std::string_view kept_in(const std::string& without) {
    return without.empty() ? "" : ", with the tip in its dimple";
  }

  std::vector<double> distances() const {
    std::vector<double> all(size());
    for (std::size_t i = 0; i < size(); ++i) all[i] = left_over(i).norm();
    return all;
  }

  // Scatter of the tip over rotating poses: a tool at rest may have much less noise than a swung one.
  double scale() const {
    std::vector<double> all = distances(), turn;
    for (std::size_t i = 0; i < size(); ++i)
      if (!rests_[i]) turn.push_back(all[i]);
    return median(turn.size() < kFewestPoses ? all : turn) / kMedianLength;
  }

  // First minimises the sum of distances, which a slip does not dominate; then least squares over the near
  // poses.
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
      const double limit = kFarthest * scale();
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
    double apart = 0.0, turning = 0.0;
    for (std::size_t i = 0; i < size(); ++i) {
      if (rests_[i]) continue;
      turning += 1.0;
      apart += weights_[i] > 0.0 ? 0.0 : 1.0;
    }
    const double share = std::fmax(static_cast<double>(fit_.outliers) / static_cast<double>(size()),
                                   turning > 0.0 ? apart / turning : 0.0);  // rests must not hide a slip
    if (fit_.rms <= kMostPivotRms && share <= kMostPivotOutliers) return;
    throw Error(fmt::format(
        "the tip did not stay: it wandered by up to {:.3g} mm, poses differ by {:.3g} mm rms, and {:.0f} % "
        "more lie apart; expected at most {:g} mm rms and {:.0f} %; hold the tip in its dimple, and see that "
        "the poses are of the markers in the tracker's frame",
        fit_.wander * 1e3, fit_.rms * 1e3, 100.0 * share, kMostPivotRms * 1e3, 100.0 * kMostPivotOutliers));
  }

  // Ranges of poses, from `first` to before `second`, each of this duration.
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

  // Mean of a pose a little before and one a little after. A pose without either does not count.
  void take_neighbours() {
    const double wanted = std::ceil(kApart / std::max(usual_step(), 1e-6));
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
    fit_.neighbours = true;
  }

  // The influence of each block of time on the tip: the difference between the tip of all blocks and that of
  // all others (jackknife). With few blocks, the residual of a block in a fit that includes it is smaller
  // than its error.
  std::array<Blocks, 3> influences(const Sums& s, double length) const {
    const Mat3 all = s.weight * s.moment, inverse = all.inverse();
    std::array<Blocks, 3> sides;
    for (const auto& [from, to] : blocks(length)) {
      Sums own;  // sums of the block, not divided by its weight, about the means of all
      Vec3 left = Vec3::Zero(), knows = Vec3::Zero();
      for (std::size_t i = from; i < to; ++i) {
        const Mat3 off = by_[i] - s.by, arm = weights_[i] * off.transpose();
        own.weight += weights_[i];
        own.by += weights_[i] * off;
        own.moment += arm * (turns_[i] - s.turn);
        own.turn += weights_[i] * (turns_[i] - s.turn);
        own.right += arm * left_over(i);
        left += weights_[i] * left_over(i);
        knows += (inverse * arm).rowwise().squaredNorm();
      }
      const Mat3 mean = own.by.transpose() / (s.weight - own.weight);
      const Mat3 others = all - own.moment - mean * own.turn;
      const Vec3 moved = others.fullPivLu().solve(own.right + mean * left);
      for (std::size_t a = 0; a < 3; ++a) {
        sides[a].influence.push_back(moved(static_cast<Eigen::Index>(a)));
        sides[a].weight.push_back(knows(static_cast<Eigen::Index>(a)));
      }
    }
    return sides;
  }

  void tell() {
    const Sums s = sums(by_, weights_);
    for (std::size_t a = 0; a < 3; ++a) fit_.tip[a].value = tip_(static_cast<Eigen::Index>(a));
    for (const double length : kLengths) {
      const std::array<Blocks, 3> found = influences(s, length);
      for (std::size_t a = 0; a < 3; ++a)
        if (found[a].freedom() >= kFewestBlocks)
          fit_.tip[a].half = std::fmax(fit_.tip[a].half, found[a].around(0.0).half);
    }
    for (std::size_t a = 0; a < 3; ++a)
      if (!std::isfinite(fit_.tip[a].value) || !std::isfinite(fit_.tip[a].half))
        throw Error(fmt::format(
            "how well the log tells the tip along {} is not known, because one short turn tells it alone; "
            "expected turns that last; swing the tool about two axes, for 10 s each",
            "xyz"[a]));
    fit_.dimple = Point<'C'>(dimple_);
    measure();
  }

  std::span<const PivotPose> poses_;
  std::vector<Mat3> turns_, by_;
  std::vector<double> weights_;
  std::vector<bool> rests_;
  std::size_t stands_ = 0;  // rests
  Vec3 tip_ = Vec3::Zero(), dimple_ = Vec3::Zero();
  PivotFit fit_;
};

}  // namespace

PivotFit fit_pivot(std::span<const PivotPose> poses) { return PivotSolver(poses).fit(); }

namespace {

// The unit of a time column that is not in seconds, if rows came at a tracker's rate.
struct TimeUnit {
  std::string_view name;
  double seconds;
};
constexpr std::array<TimeUnit, 3> kUnits{
    {{"milliseconds", 1e-3}, {"microseconds", 1e-6}, {"nanoseconds", 1e-9}}};

// Sums over consecutive poses, for R p + t = c.
struct PivotSums {
  // Sums of the squares of t (`squares`) and of R' t (`right`).
  double count = 0.0, squares = 0.0;
  Mat3 turn = Mat3::Zero();
  Vec3 place = Vec3::Zero(), right = Vec3::Zero();

  void take(const PivotPose& pose, const Vec3& origin) {
    const Mat3 R = pose.X_CT.q().normalized().toRotationMatrix();
    const Vec3 t = pose.X_CT.p() - origin;
    count += 1.0, turn += R, place += t, right += R.transpose() * t, squares += t.squaredNorm();
  }
  [[nodiscard]] PivotSums without(const PivotSums& first) const {
    return {count - first.count, squares - first.squares, turn - first.turn, place - first.place,
            right - first.right};
  }
  [[nodiscard]] Mat3 moment() const { return count * Mat3::Identity() - turn.transpose() * turn / count; }
  [[nodiscard]] Vec3 about_means() const { return right - turn.transpose() * place / count; }
  [[nodiscard]] double spread() const { return squares - place.squaredNorm() / count; }
  [[nodiscard]] Vec3 dimple(const Vec3& tip) const { return (turn * tip + place) / count; }
};

// Residual of a tip with one dimple before a pose and another from there on, m rms, and the distance of the
// dimples, m.
struct TwoDimples {
  double rms = kUnset, apart = kUnset;
};
TwoDimples two_dimples(const PivotSums& before, const PivotSums& after) {
  const Vec3 right = before.about_means() + after.about_means();
  const Vec3 tip = (before.moment() + after.moment()).fullPivLu().solve(-right);
  const double left = before.spread() + after.spread() + right.dot(tip);
  return {std::sqrt(std::max(0.0, left) / (before.count + after.count)),
          (after.dimple(tip) - before.dimple(tip)).norm()};
}

// "; from 4.00 s on it stays within 0.05 mm rms again, 30.0 mm from where it stayed before ..."
std::string moved_once(std::span<const PivotPose> poses) {
  // Each part has at least this many poses.
  constexpr std::size_t kFewest = 10;
  if (poses.size() < 2 * kFewest) return "";
  const Vec3 origin = poses.front().X_CT.p();
  PivotSums all, before;
  for (const PivotPose& pose : poses) all.take(pose, origin);
  TwoDimples best;
  std::size_t from = 0;
  for (std::size_t i = 0; i + kFewest < poses.size(); ++i) {
    before.take(poses[i], origin);
    if (i + 1 < kFewest) continue;
    const TwoDimples found = two_dimples(before, all.without(before));
    if (!(found.rms >= best.rms)) best = found, from = i + 1;
  }
  if (!(best.rms <= 0.5 * kMostPivotRms && best.apart > kMostPivotRms)) return "";
  return fmt::format(
      "; from {:.2f} s on it stays within {:.2g} mm rms again, {:.1f} mm from where it stayed before: the "
      "dimple, "
      "the tracker or its reference was moved; keep one part of the log",
      poses[from].time, best.rms * 1e3, best.apart * 1e3);
}

// The positions may belong to other rows than the rotations: "; with each place taken from 2 rows later it
// stays ..."
std::string rows_apart(std::span<const PivotPose> poses) {
  // Largest offset of rows that is tried.
  constexpr std::ptrdiff_t kMost = 10;
  const auto count = static_cast<std::ptrdiff_t>(poses.size());
  double least = 0.5 * kMostPivotRms;
  std::ptrdiff_t rows = 0;
  for (std::ptrdiff_t by = -kMost; by <= kMost; ++by) {
    std::vector<PivotPose> read;
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, -by); i < std::min(count, count - by); ++i) {
      const auto at = static_cast<std::size_t>(i), of = static_cast<std::size_t>(i + by);
      read.push_back({poses[at].time, Pose<'C', 'T'>(poses[at].X_CT.q(), poses[of].X_CT.p())});
    }
    try {
      if (const PivotFit fit = fit_pivot(read); fit.rms < least) least = fit.rms, rows = by;
    } catch (const Error&) {
      continue;  // no better than the plain reading
    }
  }
  if (rows == 0) return "";
  return fmt::format(
      "; with each place taken from {} {} it stays within {:.2g} mm rms: places and rotations "
      "are of different times",
      counted(std::abs(rows), "row"), rows > 0 ? "later" : "earlier", least * 1e3);
}

}  // namespace

std::string doubt_of_time(std::span<const PivotPose> poses) {
  constexpr double kSeldom = 0.2;                // s between rows: a tracker sends more often
  constexpr double kSeldomest = 60.0;            // s: single poses are taken faster than this
  constexpr double kFastest = 1.0;               // s between rows that a tracker sends
  constexpr double kSlow = 3.0 * M_PI / 180.0;   // rad/s, mean: slower is no swing
  constexpr double kSmall = 3.0 * M_PI / 180.0;  // rad between rows: smaller steps are no single poses
  if (poses.size() < 2) return "";
  std::vector<double> steps, turns;
  double path = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    steps.push_back(poses[i].time - poses[i - 1].time);
    turns.push_back(poses[i].X_CT.q().angularDistance(poses[i - 1].X_CT.q()));
    path += turns.back();
  }
  const double step = median(steps), lasts = poses.back().time - poses.front().time;
  if (step < kSeldom) return "";
  if (step < kSeldomest && (median(turns) > kSmall || path > kSlow * lasts)) return "";
  if (std::abs(step - 1.0) < 1e-3) return "rows are 1 s apart: frame numbers?";
  for (const TimeUnit& unit : kUnits)
    if (step * unit.seconds <= kFastest) return fmt::format("rows are {:.3g} s apart: {}?", step, unit.name);
  return fmt::format("rows are {:.3g} s apart", step);
}

Inversion doubt_of_direction(const PivotFit& fit) {
  constexpr double kLongTool = 0.25, kLongestTool = 0.75;  // m, from the markers to the tip
  constexpr double kNearer = 1.5, kFarNearer = 2.0;        // times the distance from dimple to tracker
  // A frame with its origin in the dimple has the dimple this close to it, m.
  constexpr double kAtOrigin = 0.02;
  const double tip = fit.point().e().norm(), dimple = fit.dimple.e().norm();
  const bool at_origin = dimple < kAtOrigin;
  Inversion found;
  found.doubted = tip > (at_origin ? kLongestTool : kLongTool) && tip > kNearer * dimple;
  found.sure = !at_origin && tip > kLongestTool && tip > kFarNearer * dimple;
  const std::array<double, 3>& d = fit.dimple.xyz;
  found.text = fmt::format(
      "the tip is {:.2f} m from the markers and the dimple {:.2f} m from the tracker; are these poses "
      "inverted?{} then the tip is [{:.1f}, {:.1f}, {:.1f}] mm",
      tip, dimple, at_origin ? " If the origin of the poses is at the dimple, all is well; if not," : "",
      d[0] * 1e3, d[1] * 1e3, d[2] * 1e3);
  return found;
}

std::string other_convention(std::span<const PivotPose> poses) {
  struct Convention {
    std::string_view name;
    Quat (*read)(const Quat&);
  };
  static constexpr std::array<Convention, 3> kOthers{{
      {"with qx, qy, qz negated, so the rotation is inverted", [](const Quat& q) { return q.conjugate(); }},
      {"with qw first, in the column qx", [](const Quat& q) { return Quat(q.x(), q.y(), q.z(), q.w()); }},
      {"with qw first, in the column qx, and inverted",
       [](const Quat& q) { return Quat(q.x(), -q.y(), -q.z(), -q.w()); }},
  }};
  for (const Convention& other : kOthers) {
    std::vector<PivotPose> read;
    for (const PivotPose& pose : poses)
      read.push_back({pose.time, Pose<'C', 'T'>(other.read(pose.X_CT.q()), pose.X_CT.p())});
    try {
      const PivotFit fit = fit_pivot(read);
      if (fit.rms <= 0.5 * kMostPivotRms)
        return fmt::format("; {} it stays within {:.2g} mm rms", other.name, fit.rms * 1e3);
    } catch (const Error&) {
      continue;  // no better than the plain reading
    }
  }
  const std::string moved = moved_once(poses);
  return moved.empty() ? rows_apart(poses) : moved;
}

}  // namespace enc::models
