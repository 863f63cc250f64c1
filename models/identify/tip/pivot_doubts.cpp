#include "models/identify/tip/pivot_doubts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <vector>

#include <Eigen/LU>
#include <fmt/format.h>

#include "core/base/counted.h"
#include "core/base/error.h"
#include "models/order_statistics.h"

namespace enc::models {
namespace {

// What a time in another unit than seconds would be, if rows came at a tracker's rate.
struct TimeUnit {
  std::string_view name;
  double seconds;
};
constexpr std::array<TimeUnit, 3> kUnits{
    {{"milliseconds", 1e-3}, {"microseconds", 1e-6}, {"nanoseconds", 1e-9}}};

// Sums over poses in a row, for R p + t = c.
struct PivotSums {
  // The sum of the squares of t is `squares`, that of R' t is `right`.
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

// A tip with one dimple before a pose and another from there on leaves this rms, m, with the dimples so far
// apart, m.
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
  // Either part has so many poses.
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

// The places may be of other rows than the rotations: "; with each place taken from 2 rows later it stays
// ..."
std::string rows_apart(std::span<const PivotPose> poses) {
  // Rows are looked for so far away.
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
      continue;  // no better than as it is
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
  constexpr double kSeldom = 0.2;                // s from row to row: a tracker sends more often
  constexpr double kSeldomest = 60.0;            // s: nor does anybody take poses singly so slowly
  constexpr double kFastest = 1.0;               // s from row to row, of what a tracker sends
  constexpr double kSlow = 3.0 * M_PI / 180.0;   // rad/s, in the mean: no swing
  constexpr double kSmall = 3.0 * M_PI / 180.0;  // rad from row to row: not taken singly
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
  constexpr double kNearer = 1.5, kFarNearer = 2.0;        // times, of the dimple to the tracker
  // A frame that was laid into the dimple has it so near to its origin, m.
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
      continue;  // no better than as it is
    }
  }
  const std::string moved = moved_once(poses);
  return moved.empty() ? rows_apart(poses) : moved;
}

}  // namespace enc::models
