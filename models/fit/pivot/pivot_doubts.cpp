#include "models/fit/pivot/pivot_doubts.h"

#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
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
  const double tip = fit.point().e().norm(), dimple = fit.dimple.e().norm();
  Inversion found;
  found.doubted = tip > kLongTool && tip > kNearer * dimple;
  found.sure = tip > kLongestTool && tip > kFarNearer * dimple;
  const std::array<double, 3>& d = fit.dimple.xyz;
  found.text = fmt::format(
      "the tip is {:.2f} m from the markers and the dimple {:.2f} m from the tracker; are these poses "
      "inverted? then the tip is [{:.1f}, {:.1f}, {:.1f}] mm",
      tip, dimple, d[0] * 1e3, d[1] * 1e3, d[2] * 1e3);
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
  return "";
}

}  // namespace enc::models
