#include "core/guard/room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "core/mesh/mesh_tree.h"

namespace enc {
namespace {

// Where the object is deepest, from p on: away from whichever side is nearest, by less where that leads
// nowhere.
Room deepest_from(const Surface& surface, Point<'O'> p, double margin, std::int32_t& feature) {
  constexpr int kSteps = 32;
  Room room;
  Vec3 away = Vec3::Zero();
  double share = 1.0;
  for (int i = 0; i < kSteps; ++i) {
    const Nearest near = surface.nearest(p, feature);
    feature = near.feature;
    if (i == 0 || -near.distance > room.deepest) {
      room.deepest = -near.distance;
      room.at = p;
      away = -near.normal.e();
    } else {
      share *= 0.5;
    }
    if (room.deepest >= margin) break;
    p = Point<'O'>(Vec3(room.at.e() + share * (margin - room.deepest) * away));
  }
  return room;
}

Room room_in_mesh(const MeshTree& tree, const Surface& surface, double margin, std::size_t samples) {
  constexpr double kOpposite = -0.5;  // of the normals of two sides: else it is an edge, not a thin place
  const Mesh& mesh = tree.mesh();
  const std::size_t all = mesh.triangles.size();
  const std::size_t step = samples == 0 ? 1 : std::max<std::size_t>(1, all / samples);
  Room room;
  room.deepest = -std::numeric_limits<double>::infinity();
  room.thinnest = std::numeric_limits<double>::infinity();
  double area = 0.0, thin = 0.0;
  std::int32_t feature = -1;
  for (std::size_t i = 0; i < all; i += step) {
    std::array<Vec3, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& v = mesh.vertices[static_cast<std::size_t>(mesh.triangles[i][k])];
      corner[k] = Vec3(v[0], v[1], v[2]);
    }
    const Vec3 across = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const double size = 0.5 * across.norm();
    if (!(size > 0.0)) continue;
    const Vec3 normal = across.normalized();
    const Vec3 on = (corner[0] + corner[1] + corner[2]) / 3.0;
    const Point<'O'> under(Vec3(on - margin * normal));
    const Nearest near = surface.nearest(under, feature);
    feature = near.feature;
    area += size;
    const double depth = -near.distance;
    if (depth < margin - 1e-6 && near.normal.e().dot(normal) < kOpposite) {
      thin += size;
      const double thickness = margin + depth;  // from this side to that one
      if (thickness < room.thinnest) {
        room.thinnest = thickness;
        room.thin_at = Point<'O'>(on);
      }
    }
    if (room.deepest >= margin) continue;
    const Room deeper = deepest_from(surface, under, margin, feature);
    if (deeper.deepest > room.deepest) {
      room.deepest = deeper.deepest;
      room.at = deeper.at;
    }
  }
  room.thin = area > 0.0 ? thin / area : 0.0;
  return room;
}

}  // namespace

Room room_in(const Object& object, double margin, std::size_t samples) {
  const Point<'O'> middle(0, 0, 0);
  Room room{margin, middle, 0.0, middle, margin};
  const Surface::Shape& shape = object.surface.shape();
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    room.deepest = std::min(margin, sphere->radius);
  } else if (const auto* mesh = std::get_if<MeshSurface>(&shape)) {
    room = room_in_mesh(*mesh->tree, object.surface, margin, samples);
  }
  return room;
}

void check_room(const SceneSpec& spec, const Scene& scene) {
  if (scene.probe || scene.travel) return;
  constexpr std::size_t kSamples = 1000;
  constexpr double kRounding = 1e-6;  // m
  const double margin = room_margin(scene);
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Room room = room_in(scene.objects[i], margin, kSamples);
    if (room.deepest >= margin - kRounding) continue;
    const Point<'W'> at = scene.objects[i].X_WO * room.at;
    const auto mm = [](double x) {  // no locale
      const long tenths = std::lround(1e4 * x);
      return (tenths < 0 ? "-" : "") + std::to_string(std::abs(tenths) / 10) + "." +
             std::to_string(std::abs(tenths) % 10);
    };
    throw Error(
        "object '" + spec.objects[i].name + "' is thinner than the haptic-tip: where it is thickest, at (" +
            mm(at.xyz[0]) + ", " + mm(at.xyz[1]) + ", " + mm(at.xyz[2]) + ") mm, it is " +
            mm(2.0 * room.deepest) + " mm; expected at least " + mm(2.0 * margin) +
            " mm, the tip and its inset; make the object larger, or rig.manipulator.tip_radius or "
            "follow.inset smaller",
        "object." + spec.objects[i].name + (spec.objects[i].shape == ShapeKind::mesh ? ".mesh" : ".radius"));
  }
}

}  // namespace enc
