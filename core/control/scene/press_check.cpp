#include "core/control/scene/press_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/control/safety/inside.h"
#include "core/shape/surface/mesh_tree.h"

namespace enc {
namespace {

// Everything is symmetric about H's z axis, so a half plane is enough: distance from the axis, and height
// above H.
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
  // Distance to the part of the line from a to b; a is nearer to the axis. 0 if the line passes through.
  [[nodiscard]] double to(const Place& a, const Place& b) const {
    double from = 0.0, until = 1.0;  // share of the line between top and bottom
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

namespace {

// Centre of a triangle, its outward normal and its area.
struct Facet {
  Vec3 on, normal;
  double area = 0.0;
};
Facet facet_of(const Mesh& mesh, std::size_t i) {
  std::array<Vec3, 3> corner;
  for (std::size_t k = 0; k < 3; ++k)
    corner[k] = Vec3(mesh.vertices[static_cast<std::size_t>(mesh.triangles[i][k])].data());
  const Vec3 across = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  return {(corner[0] + corner[1] + corner[2]) / 3.0, across.normalized(), 0.5 * across.norm()};
}

// Finds a position of that depth near p; false if no such position exists.
bool place_of_depth(const Object& object, double depth, const Vec3& p, Point<'O'>& at) {
  ObjectHint hint;
  stages::Inside inside(object, depth, Vec<'W'>::zero(), hint);
  const Point<'W'> found = inside.nearest_to(object.X_WO * Point<'O'>(p));
  at = object.X_OW * found;
  return inside.depth(found) >= depth - 1e-6;
}

// Finds the deepest position near p by bisection.
void deepen(const Object& object, double margin, const Vec3& p, Room& room) {
  double high = margin;
  Vec3 from = p;
  while (high - room.deepest > 1e-5) {
    const double middle = 0.5 * (std::max(0.0, room.deepest) + high);
    Point<'O'> at;
    if (place_of_depth(object, middle, from, at)) {
      room.deepest = middle;
      room.at = at;
      from = at.e();
    } else {
      high = middle;
    }
  }
}

// The object has room if one position has it. A few triangles usually show that. All triangles are tried
// before the answer is no.
void find_room(const Object& object, const Mesh& mesh, double margin, Room& room) {
  constexpr std::size_t kFew = 200;
  const std::size_t all = mesh.triangles.size();
  for (const std::size_t step : {std::max<std::size_t>(1, all / kFew), std::size_t{1}})
    for (std::size_t i = 0; i < all; i += step) {
      const Facet facet = facet_of(mesh, i);
      if (!(facet.area > 0.0)) continue;
      if (!place_of_depth(object, margin, facet.on - margin * facet.normal, room.at)) continue;
      room.deepest = margin;
      return;
    }
  room.deepest = 0.0;
  for (std::size_t i = 0; i < all; i += std::max<std::size_t>(1, all / kFew)) {
    const Facet facet = facet_of(mesh, i);
    if (facet.area > 0.0) deepen(object, margin, facet.on - 0.25 * margin * facet.normal, room);
  }
}

// Cosine between the normals of two opposite sides (assumed: no source).
constexpr double kOpposite = -0.5;

// Finds where the opposite side is nearer than the tip needs. Near an edge another side is close, but it is
// not opposite.
void find_thin(const Object& object, const Mesh& mesh, double margin, Room& room) {
  room.thinnest = std::numeric_limits<double>::infinity();
  double area = 0.0, thin = 0.0;
  std::int32_t feature = -1;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Facet facet = facet_of(mesh, i);
    if (!(facet.area > 0.0)) continue;
    const SurfacePoint near =
        object.surface.nearest(Point<'O'>(Vec3(facet.on - margin * facet.normal)), feature);
    feature = near.feature;
    area += facet.area;
    if (-near.distance >= margin - 1e-6 || near.normal.e().dot(facet.normal) >= kOpposite) continue;
    thin += facet.area;
    if (margin - near.distance >= room.thinnest) continue;
    room.thinnest = margin - near.distance;  // distance to the opposite side
    room.thin_at = Point<'O'>(facet.on);
  }
  room.thin = area > 0.0 ? thin / area : 0.0;
}

}  // namespace

Room room_in(const Object& object, double margin, bool thin) {
  const Point<'O'> middle(0, 0, 0);
  Room room{margin, middle, 0.0, middle, margin};
  const Surface::Shape& shape = object.surface.shape();
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    room.deepest = std::min(margin, sphere->radius);
  } else if (const auto* mesh = std::get_if<MeshSurface>(&shape)) {
    find_room(object, mesh->tree->mesh(), margin, room);
    if (thin) find_thin(object, mesh->tree->mesh(), margin, room);
  }
  return room;
}

bool room_under(const Object& object, double margin, const Point<'W'>& on, const Vec<'W'>& normal) {
  const SurfacePoint near = object.surface.nearest(object.X_OW * (on - margin * normal));
  return -near.distance >= margin - 1e-6 || dot(object.X_WO * near.normal, normal) >= kOpposite;
}

void check_room(const SceneSpec& spec, const Scene& scene) {
  if (scene.admittance() == nullptr) return;
  constexpr double kRounding = 1e-6;  // m
  const double margin = room_margin(scene);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Room room = room_in(scene.objects[i], margin, false);
    if (room.deepest >= margin - kRounding) continue;
    const Point<'W'> at = scene.objects[i].X_WO * room.at;
    const auto mm = [](double x) {  // no locale
      const long tenths = std::lround(std::clamp(1e4 * x, -1e15, 1e15));
      return (tenths < 0 ? "-" : "") + std::to_string(std::abs(tenths) / 10) + "." +
             std::to_string(std::abs(tenths) % 10);
    };
    throw Error("object '" + spec.objects[i].name +
                    "' is thinner than the haptic-tip: where it is thickest, at (" + mm(at.xyz[0]) + ", " +
                    mm(at.xyz[1]) + ", " + mm(at.xyz[2]) + ") mm, it is " + mm(2.0 * room.deepest) +
                    " mm; expected at least " + mm(2.0 * margin) +
                    " mm, the tip and its inset; make the object larger, or rig.manipulator.tip_radius_mm or "
                    "follow.inset_mm smaller",
                "object." + spec.objects[i].name + size_key(spec.objects[i].shape));
  }
  if (!spec.user || spec.user->kind != UserKind::press_release) return;
  const PressPoint pressed = press_point(spec, *spec.user);
  const std::size_t index = pressed_object(spec.objects, spec.user->object, "user");
  if (!room_under(scene.objects[index], margin, pressed.point, pressed.normal))
    throw Error(
        "the user presses where object '" + spec.objects[index].name +
            "' is thinner than the haptic-tip and its inset, so that it cannot be there; press elsewhere "
            "(encounter check says where it is thin)",
        "user.object");
}

}  // namespace enc
