#include "core/control/world/object.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/shape/surface/mesh_tree.h"

namespace enc {

LimitCheck check_limits(const ObjectSpec& object, double most) {
  const bool one = !std::isnan(object.limit);
  if (one && !object.limits.empty()) return {LimitFault::two_keys};
  if (object.limits.size() > ContactLimits::kMost) return {LimitFault::too_many};
  const std::vector<double> asked = one ? std::vector<double>{object.limit} : object.limits;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    if (!(asked[i] > 0.0)) return {LimitFault::not_positive, i};
    if (object.shape == ShapeKind::sphere && asked[i] >= object.radius) return {LimitFault::beyond_radius, i};
    if (most > 0.0 && asked[i] > most * (1.0 + 1e-12)) return {LimitFault::beyond_behaviour, i};
  }
  return {};
}

Mesh scaled_mesh(const ObjectSpec& spec) {
  if (!spec.surface || spec.surface->triangles.empty())
    throw Error("no mesh was loaded for this object", "object." + spec.name + ".mesh");
  if (!(spec.scale > 0.0)) throw Error("a mesh needs a positive scale", "object." + spec.name + ".scale");
  Mesh mesh = *spec.surface;
  for (auto& vertex : mesh.vertices)
    for (double& x : vertex) {
      x *= spec.scale;
      if (!(std::abs(x) <= kFarthestVertex) && spec.shape == ShapeKind::box)
        throw Error("this box reaches beyond 1000 km; expected less; make it smaller",
                    "object." + spec.name + ".size");
      if (!(std::abs(x) <= kFarthestVertex))
        throw Error("with this scale the mesh reaches beyond 1000 km; expected less; make it smaller",
                    "object." + spec.name + ".scale");
    }
  return mesh;
}

Surface surface_of(const ObjectSpec& spec) {
  if (spec.shape == ShapeKind::plane) return Surface(Plane{});
  if (has_triangles(spec.shape))
    return Surface(MeshSurface{std::make_shared<const MeshTree>(scaled_mesh(spec))});
  if (spec.shape == ShapeKind::button) {
    if (!(spec.width > 0.0) || !(spec.height > 0.0) || !(spec.thickness > 0.0))
      throw Error("a button has a width, a height and a thickness",
                  "object." + spec.name +
                      (spec.width > 0.0 ? spec.height > 0.0 ? ".thickness" : ".height" : ".width"));
    return Surface(Button{spec.width, spec.height, spec.thickness});
  }
  if (!(spec.radius > 0.0)) throw Error("a sphere needs a radius", "object." + spec.name + ".radius");
  return Surface(Sphere{spec.radius});
}

Pose<'W', 'O'> place_of(const ObjectSpec& spec) {
  if (spec.shape == ShapeKind::sphere) return {Quat::Identity(), spec.position};
  if (has_triangles(spec.shape)) return {rotation_xyz(spec.rotation), spec.position};
  const double size = spec.normal.norm();
  if (!(std::abs(size - 1.0) <= 1e-3))
    throw Error("the normal of a plane or a button is a unit vector", "object." + spec.name + ".normal");
  return {rotation_z_to(spec.normal / size), spec.position};
}

const BehaviourSpec& behaviour_of(const std::vector<BehaviourSpec>& behaviours, const ObjectSpec& object) {
  const auto found = std::find_if(behaviours.begin(), behaviours.end(),
                                  [&](const BehaviourSpec& b) { return b.name == object.behaviour; });
  if (found == behaviours.end())
    throw Error("no behaviour '" + object.behaviour + "' in the database",
                "object." + object.name + ".behaviour");
  return *found;
}

// The object that `who` ("user", "pusher") presses: the named one, or the first.
std::size_t pressed_object(const std::vector<ObjectSpec>& objects, const std::string& name,
                           const std::string& who) {
  if (objects.empty()) throw Error("a " + who + " needs an object to press", who + ".object");
  if (name.empty()) return 0;
  const auto named =
      std::find_if(objects.begin(), objects.end(), [&](const ObjectSpec& o) { return o.name == name; });
  if (named == objects.end()) throw Error("no object '" + name + "' in the scene", who + ".object");
  return static_cast<std::size_t>(named - objects.begin());
}

}  // namespace enc
