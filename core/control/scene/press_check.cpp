#include "core/control/scene/press_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace enc {
namespace {

// All is round about H's z axis, so a half plane will do: distance from the axis, and height above H.
using Place = Eigen::Vector2d;

double to_segment(const Place& p, const Place& a, const Place& b) {
  const Place ab = b - a;
  const double share =
      ab.squaredNorm() > 0.0 ? std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0) : 0.0;
  return (p - a - share * ab).norm();
}

struct Body {
  double radius, top, bottom;  // m
  [[nodiscard]] double to(const Place& p) const {
    return Place(std::max(p.x() - radius, 0.0), std::max({p.y() - top, bottom - p.y(), 0.0})).norm();
  }
  // Of the line from a to b, where a is nearer to the axis. 0 where it passes through.
  [[nodiscard]] double to(const Place& a, const Place& b) const {
    double from = 0.0, until = 1.0;  // share of the line that lies between top and bottom
    const double rise = b.y() - a.y();
    if (rise != 0.0) {
      const double one = (top - a.y()) / rise, other = (bottom - a.y()) / rise;
      from = std::max(from, std::min(one, other));
      until = std::min(until, std::max(one, other));
    } else if (a.y() > top || a.y() < bottom) {
      from = 2.0;
    }
    if (from <= until && a.x() + from * (b.x() - a.x()) <= radius) return 0.0;
    return std::min({to(a), to(b), to_segment({radius, top}, a, b), to_segment({radius, bottom}, a, b)});
  }
};

}  // namespace

bool carried_to(const Scene& scene, const PressPoint& press, double depth) {
  const Point<'W'> tip = press.point - (scene.tip_radius + depth) * press.normal;
  return scene.reach.contains(Pose<'R', 'H'>(scene.X_WR.q().conjugate(), scene.X_WR.inverse() * tip));
}

std::string_view obstacle_name(Obstacle obstacle) {
  static constexpr std::array<std::string_view, 4> kNames{"nothing", "stem", "gripper", "platform"};
  return kNames[static_cast<std::size_t>(obstacle)];
}

Obstacle in_the_way(const Scene& scene, const Vec<'W'>& normal, const Tool& tool) {
  const Mount& mount = scene.reach.mount;
  const double up = std::clamp(normal.xyz[2] / normal.norm(), -1.0, 1.0);
  const Place along(std::sqrt(1.0 - up * up), up);
  const double start = scene.tip_radius + tool.tip.radius;
  const Place a = start * along;
  const Place b = (start + tool.length) * along;
  const double low = -std::numeric_limits<double>::infinity();
  const std::array<std::pair<Obstacle, Body>, 3> bodies{
      {{Obstacle::stem, {mount.stem_radius, 0.0, -mount.gripper_depth}},
       {Obstacle::gripper, {mount.gripper_radius, -mount.gripper_depth, -mount.platform_depth}},
       {Obstacle::platform, {mount.platform_radius, -mount.platform_depth, low}}}};
  for (const auto& [obstacle, body] : bodies)
    if (body.radius > 0.0 && body.to(a, b) < tool.tip.radius) return obstacle;
  return Obstacle::none;
}

double steepest_press(const Scene& scene, const Tool& tool) {
  double free = 0.0, blocked = std::numbers::pi;
  const auto is_free = [&](double polar) {
    return in_the_way(scene, {std::sin(polar), 0.0, std::cos(polar)}, tool) == Obstacle::none;
  };
  if (is_free(blocked)) return blocked;
  while (blocked - free > 1e-9) {
    const double middle = 0.5 * (free + blocked);
    (is_free(middle) ? free : blocked) = middle;
  }
  return free;
}

}  // namespace enc
