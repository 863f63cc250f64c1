// What stands in a scene and how it answers: objects and the behaviours they name. Parts of the scene file
// (scene_spec.h); SI.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "core/base/words.h"
#include "core/shape/response/response.h"
#include "core/shape/surface/mesh.h"
#include "core/spec/interaction.h"
#include "core/spec/surface_material.h"

namespace enc {

enum class ShapeKind : std::uint8_t { plane, sphere, mesh, button, box };
constexpr auto words(ShapeKind) { return enum_words("plane", "sphere", "mesh", "button", "box"); }
// The key that says how large it is, as messages name it; of a plane none does.
constexpr const char* size_key(ShapeKind shape) {
  return shape == ShapeKind::mesh ? ".mesh" : shape == ShapeKind::box ? ".size" : ".radius";
}
// Whether its surface is triangles, ObjectSpec::surface.
constexpr bool has_triangles(ShapeKind shape) { return shape == ShapeKind::mesh || shape == ShapeKind::box; }

enum class Tangential : std::uint8_t {
  stick,  // the tip stays over its contact point, whatever the sideways force (default)
  spring  // the contact point gives sideways by force / tangential_stiffness
};
constexpr auto words(Tangential) { return enum_words("stick", "spring"); }

// An entry of models/behaviours.toml: how a surface answers. Objects name it.
struct BehaviourSpec {
  std::string name;
  std::string response{};                     // file in models/responses without ".toml"; or empty and then
  double stiffness = kUnset;                  // N/m: a linear spring, press and release alike
  double limit = kUnset;                      // deflection limit, m; unset: that of the response file
  Reversal reversal = Reversal::energy_stop;  // which of the file's models is felt
  Tangential tangential = Tangential::stick;
  double tangential_stiffness = kUnset;  // N/m, with Tangential::spring
  InteractionSpec interaction{};         // beyond a press
  ResponseSpec curves{};                 // filled by the loader from the response file or the stiffness
};

struct ObjectSpec {
  std::string name;
  ShapeKind shape = ShapeKind::sphere;
  double radius = kUnset;                  // sphere
  Vec3 position{0, 0, 0};                  // of O in W
  Vec3 normal{0, 0, 1};                    // plane, button: outward, unit, in W
  double width = kUnset, height = kUnset;  // button: of its face, m [VisHap 2.2]
  double thickness = 0.050;                // button: of the solid behind its face, m
  std::string behaviour;                   // by name; empty: a real thing, for [probe] alone
  double limit = kUnset;                   // deflection limit, m; unset: the behaviour's
  // Instead, m: the k-th contact of the experiment takes the k-th, the last one stays (contact_limits.h).
  std::vector<double> limits{};
  MaterialName material = MaterialName::unnamed;

  Vec3 size{kUnset, kUnset, kUnset};  // box: its edges along x, y and z of O, which is in its middle, m

  // mesh; rotation and surface of a box, too
  std::string mesh{};                             // file
  std::string mesh_hash{};                        // of its content, 16 hex digits; empty: not known
  double scale = 1.0;                             // of the file's metres
  Vec3 rotation{0, 0, 0};                         // of O in W, about the fixed x, then y, then z axis, rad
  std::shared_ptr<const Mesh> surface{};          // filled by the loader; unscaled, closed, outward
  std::optional<SurfaceMaterial> own_material{};  // likewise: of the mesh's file
};

}  // namespace enc
