#include "core/control/safety/inside.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace enc::stages {
namespace {

// The half space n x <= b.
struct Wall {
  Vec3 n{0, 0, 1};
  double b = 0.0;
  [[nodiscard]] double beyond(const Vec3& x) const { return n.dot(x) - b; }
};

constexpr std::size_t kWalls = 4;
constexpr double kClose = 1e-7;   // m: distance within which a point lies on a wall
constexpr double kSlack = 15e-6;  // m: accepted lack of depth of the centre; the guard's own limit is 50 um
constexpr double kCut = 10e-6;    // m: additional lack of depth accepted on the path
// Steps from wall to wall before the deepest position so far is taken (assumed: no source).
constexpr int kTries = 12;
// m: a step along a braking path (derived: at a hollow edge, an arc of the tip's radius, it cuts off 9 um).
constexpr double kLeastStep = 0.6e-3;
constexpr int kMostSteps = 64;      // steps of a braking path (assumed: a tip that needs more is too fast)
constexpr double kParallel = 1e-6;  // determinant of unit vectors

// Solves G y = r for the walls of a set, at most three. G holds the products of their normals. False if they
// are parallel.
bool solve(const std::array<std::array<double, 3>, 3>& G, const std::array<double, 3>& r, std::size_t n,
           std::array<double, 3>& y) {
  if (n == 1) {
    y[0] = r[0];
    return true;
  }
  if (n == 2) {
    const double det = 1.0 - G[0][1] * G[0][1];
    if (det < kParallel) return false;
    y[0] = (r[0] - G[0][1] * r[1]) / det;
    y[1] = (r[1] - G[0][1] * r[0]) / det;
    return true;
  }
  const double a = G[0][1], b = G[0][2], c = G[1][2];
  const double det = 1.0 + 2.0 * a * b * c - a * a - b * b - c * c;
  if (det < kParallel) return false;
  y[0] = ((1.0 - c * c) * r[0] + (b * c - a) * r[1] + (a * c - b) * r[2]) / det;
  y[1] = ((b * c - a) * r[0] + (1.0 - b * b) * r[1] + (a * b - c) * r[2]) / det;
  y[2] = ((a * c - b) * r[0] + (a * b - c) * r[1] + (1.0 - a * a) * r[2]) / det;
  return true;
}

// The point within all walls that is nearest to x. It lies on one of the sets of walls, and the search tries
// these sets. False if there is no such point.
bool project(const std::array<Wall, kWalls>& walls, std::size_t count, const Vec3& x, Vec3& out) {
  for (unsigned set = 1; set < 1U << count; ++set) {
    std::array<const Wall*, 3> on{};
    std::size_t n = 0;
    bool few = true;
    for (std::size_t i = 0; i < count; ++i) {
      if ((set >> i & 1U) == 0) continue;
      if (n == on.size())
        few = false;
      else
        on[n++] = &walls[i];
    }
    if (!few) continue;
    std::array<std::array<double, 3>, 3> G{};
    std::array<double, 3> r{}, push{};
    for (std::size_t i = 0; i < n; ++i) {
      r[i] = on[i]->beyond(x);
      for (std::size_t j = 0; j < n; ++j) G[i][j] = on[i]->n.dot(on[j]->n);
    }
    if (!solve(G, r, n, push)) continue;
    Vec3 p = x;
    bool pushes = true;
    for (std::size_t i = 0; i < n; ++i) {
      pushes = pushes && push[i] >= 0.0;
      p -= push[i] * on[i]->n;
    }
    if (!pushes) continue;
    const auto within = [&](const Wall& wall) { return wall.beyond(p) <= kClose; };
    if (!std::all_of(walls.begin(), walls.begin() + static_cast<std::ptrdiff_t>(count), within)) continue;
    out = p;
    return true;
  }
  return false;
}

}  // namespace

Inside::Inside(const CommonScene& scene, std::int32_t object, double margin, const Vec<'W'>& shift,
               ObjectHint& hint)
    : Inside(scene.objects[static_cast<std::size_t>(object)], margin, shift, hint) {
  if (hint_.object != object) hint_ = {object, -1};
}

Inside::Inside(const Object& object, double margin, const Vec<'W'>& shift, ObjectHint& hint)
    : object_(object), margin_(margin), shift_(shift), hint_(hint) {}

SurfacePoint Inside::at(const Point<'O'>& p) noexcept {
  const SurfacePoint found = object_.surface.nearest(p, hint_.feature);
  hint_.feature = found.feature;
  return found;
}

Point<'W'> Inside::nearest_to(const Point<'W'>& wanted) noexcept {
  const Point<'O'> from = local(wanted);
  Point<'O'> p = from;
  double best = -std::numeric_limits<double>::infinity();
  Point<'O'> best_p = from;
  std::array<Wall, kWalls> walls;
  std::size_t count = 0, next = 0;
  for (int i = 0; i < kTries; ++i) {
    const SurfacePoint near = at(p);
    if (!std::isfinite(near.distance)) return wanted;
    const double depth = -near.distance;
    if (depth >= margin_ - kClose) return i == 0 ? wanted : object_.X_WO * p + shift_;
    if (depth > best) {
      best = depth;
      best_p = p;
    }
    walls[next] = {near.normal.e(), near.normal.e().dot(near.point.e()) - margin_};
    next = (next + 1) % kWalls;
    count = std::min(count + 1, kWalls);
    Vec3 to = p.e();
    // These walls leave no room, because the object is thin or concave there. Then only the last wall counts.
    if (!project(walls, count, from.e(), to)) {
      walls[0] = walls[(next + kWalls - 1) % kWalls];
      count = next = 1;
      to = p.e() - (near.distance + margin_) * near.normal.e();
    }
    p = Point<'O'>(to);
  }
  return object_.X_WO * best_p + shift_;
}

// True if the tip may move at v: both its stopping position and the path there are deep enough. `met`:
// nearest surface point of the first position that is not deep enough.
bool Inside::stops_inside(const Brake& brake, double depth, const Vec3& v, SurfacePoint& met) noexcept {
  const Vec3 way = braking_way(v, brake.acceleration, brake.dt);
  const double length = way.norm();
  const double least = stop_depth(depth);
  if (depth - length >= least) return true;  // depth changes no faster than position
  met = at(local(Point<'W'>(Vec3(brake.at.e() + way))));
  if (!(-met.distance >= least)) return false;
  // The same bound from both ends of the path.
  if (0.5 * (depth - met.distance - length) >= least) return true;
  // Only a mesh can be hollow; all other shapes are convex.
  if (!std::holds_alternative<MeshSurface>(object_.surface.shape())) return true;
  // Check the path: first the position after this tick, where the command may still change, then steps so
  // short that no side can enter between them. At a hollow edge the allowed region ends in an arc of the
  // tip's radius; a step cuts off 9 um of it.
  const double floor = std::min(least, margin_ - kSlack - kCut);
  double gone = brake.dt * v.norm();
  if (depth - floor > gone) gone = std::max(depth - floor, kLeastStep);
  for (int i = 0; gone < length; ++i) {
    const SurfacePoint between = at(local(Point<'W'>(Vec3(brake.at.e() + (gone / length) * way))));
    if (i == kMostSteps || !(-between.distance >= floor)) {
      met = between;
      return false;
    }
    gone += std::max(-between.distance - floor, kLeastStep);
  }
  return true;
}

// The stopping position is `margin` deep, less the slack. The path may cut off a little more between two
// steps, twice. A tip that is farther out moves to deeper positions.
double Inside::stop_depth(double here) const {
  return here < margin_ - kSlack - 2.0 * kCut ? here : margin_ - kSlack;
}

Vec3 Inside::velocity(const Brake& brake, double here, const Vec3& wanted) noexcept {
  SurfacePoint met;
  if (stops_inside(brake, here, wanted, met)) return wanted;
  const double most = brake.acceleration * brake.dt;
  const double least = stop_depth(here);
  Vec3 v = wanted;
  for (int i = 0; i < 3; ++i) {  // along the first wall met, then along the next
    const Vec3 normal = object_.X_WO.q() * met.normal.e();
    const double lever = brake.dt + v.norm() / (2.0 * brake.acceleration);
    v -= (least + met.distance) / lever * normal;
    const Vec3 change = v - brake.velocity;
    if (change.norm() > most) v = brake.velocity + change * (most / change.norm());
    if (v.norm() > brake.speed) v *= brake.speed / v.norm();
    if (stops_inside(brake, here, v, met)) return v;
  }
  // Braking was possible a tick ago, so it is possible now.
  const Vec3 braked = slowed(brake.velocity, most);
  double good = 0.0;
  for (double bad = 1.0; bad - good > 0.1;) {
    const double share = 0.5 * (good + bad);
    (stops_inside(brake, here, braked + share * (v - braked), met) ? good : bad) = share;
  }
  return braked + good * (v - braked);
}

}  // namespace enc::stages
