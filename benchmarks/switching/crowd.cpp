#include "benchmarks/switching/crowd.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <random>

#include "core/base/rotation.h"
#include "core/shape/surface/mesh_tree.h"
#include "models/shapes/shapes.h"

namespace enc::bench::switching {
namespace {

class Crowd {
 public:
  explicit Crowd(std::uint64_t seed) : random_(seed) {
    for (std::size_t i = 0; i < solids_.size(); ++i)
      solids_[i] = std::make_shared<const MeshTree>(i % 2 == 0 ? models::geodesic_ball(2, 0.006 + 0.002 * i)
                                                               : models::cube(2, 0.010 + 0.003 * i));
  }

  Object next(std::size_t index) {
    const Quat turn = rotation_z_to(way());
    if (index % 50 == 49) {  // a wall of the room
      const Vec3 n = way();
      return object(Surface(Plane{}), {rotation_z_to(n), Vec3(-2.0 * kCrowdRoom * n)});
    }
    const Vec3 place(even(-kCrowdRoom, kCrowdRoom), even(-kCrowdRoom, kCrowdRoom),
                     even(-kCrowdRoom, kCrowdRoom));
    if (index % 5 == 4) return object(Surface(MeshSurface{solids_[index % solids_.size()]}), {turn, place});
    if (index % 2 == 0) return object(Surface(Sphere{even(0.003, 0.015)}), {Quat::Identity(), place});
    return object(Surface(Button{even(0.008, 0.020), even(0.008, 0.020), 0.010}), {turn, place});
  }

 private:
  static Object object(Surface surface, const Pose<'W', 'O'>& X_WO) {
    Object made{std::move(surface), X_WO, {}};
    made.interaction.kind = Interaction::slide;
    made.stiffness = 1000.0;
    return made;
  }
  double even(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Vec3 way() {
    std::normal_distribution<double> bell;
    const double x = bell(random_), y = bell(random_), z = bell(random_);
    return Vec3(x, y, z).normalized();
  }

  std::mt19937_64 random_;
  std::array<std::shared_ptr<const MeshTree>, 4> solids_;
};

}  // namespace

void fill_with_crowd(Scene& scene, std::size_t count, std::uint64_t seed) {
  Crowd crowd(seed);
  scene.objects.clear();
  for (std::size_t i = 0; i < count; ++i) scene.objects.push_back(crowd.next(i));
}

NearestObject brute_force(const Scene& scene, const Point<'W'>& p) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  NearestObject best{-1, kFar, kFar};
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    const double distance = object.surface.nearest(object.X_WO.inverse() * p).distance;
    best.next = std::min(best.next, std::max(distance, best.distance));
    if (!(distance < best.distance)) continue;
    best.object = static_cast<std::int32_t>(i);
    best.distance = distance;
  }
  return best;
}

std::int32_t nearest_for_a_finger(const Scene& scene, const Point<'W'>& p, double radius) {
  std::int32_t touched = -1;
  double least = radius;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    const SurfacePoint at = object.surface.nearest(object.X_WO.inverse() * p);
    const bool button = std::holds_alternative<Button>(object.surface.shape());
    if (at.distance > least || (button && at.feature == kButtonSide)) continue;
    if (touched >= 0 && at.distance == least) continue;  // the first of equals
    least = at.distance;
    touched = static_cast<std::int32_t>(i);
  }
  return touched >= 0 ? touched : brute_force(scene, p).object;
}

double distance_to(const Scene& scene, std::int32_t index, const Point<'W'>& p) {
  const Object& object = scene.objects[static_cast<std::size_t>(index)];
  return object.surface.nearest(object.X_WO.inverse() * p).distance;
}

}  // namespace enc::bench::switching
