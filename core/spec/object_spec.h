// Objects of a scene, their looks, and the behaviours that they name. Parts of the scene file (scene_spec.h);
// SI.
#pragma once

#include <array>
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

namespace enc {

// The look of an object: one of a small library by name, or the material of a glTF file [VHMR 3.5]. Only
// pictures use it.
enum class MaterialName : std::uint8_t {
  unnamed,  // the mesh file's material, else by shape
  felt,
  rubber,
  plastic,
  wood,
  steel,
  brass,
  glass
};
constexpr auto words(MaterialName) {
  return enum_words("unnamed", "felt", "rubber", "plastic", "wood", "steel", "brass", "glass");
}

// Values as in glTF 2.0, each from 0 to 1.
struct SurfaceMaterial {
  std::array<float, 3> colour{1, 1, 1};  // red, green, blue, in the screen's encoding
  float metallic = 0.0F, roughness = 1.0F;
  float opacity = 1.0F;
};

enum class ShapeKind : std::uint8_t { plane, sphere, mesh, button, box };
constexpr auto words(ShapeKind) { return enum_words("plane", "sphere", "mesh", "button", "box"); }
// The key of an object's size, as messages name it; a plane has no such key.
constexpr const char* size_key(ShapeKind shape) {
  return shape == ShapeKind::mesh ? ".mesh" : shape == ShapeKind::box ? ".size" : ".radius";
}
// True if the surface consists of triangles, ObjectSpec::surface.
constexpr bool has_triangles(ShapeKind shape) { return shape == ShapeKind::mesh || shape == ShapeKind::box; }

enum class TangentialMode : std::uint8_t {
  stick,  // the tip stays over its contact point, whatever the sideways force (default)
  spring  // the contact point yields sideways by force / tangential_stiffness
};
constexpr auto words(TangentialMode) { return enum_words("stick", "spring"); }

// An entry of models/behaviours.toml: the response of a surface. Objects name it.
struct BehaviourSpec {
  std::string name;
  std::string response{};     // file in models/responses without ".toml"; empty: use `stiffness`
  double stiffness = kUnset;  // N/m: a linear spring, equal for press and release
  double limit = kUnset;      // deflection limit, m; unset: that of the response file
  Reversal reversal = Reversal::energy_stop;  // the model of the file that is rendered
  TangentialMode tangential = TangentialMode::stick;
  double tangential_stiffness = kUnset;  // N/m, with Tangential::spring
  InteractionSpec interaction{};         // other interactions than a press
  ResponseSpec curves{};                 // filled by the loader from the response file or the stiffness
};

struct ObjectSpec {
  std::string name;
  ShapeKind shape = ShapeKind::sphere;
  double radius = kUnset;                  // sphere
  Vec3 position{0, 0, 0};                  // origin of O in W
  Vec3 normal{0, 0, 1};                    // plane, button: outward, unit, in W
  double width = kUnset, height = kUnset;  // button: size of its face, m [VisHap 2.2]
  double thickness = 0.050;                // button: thickness of the solid behind its face, m
  std::string behaviour;                   // name; empty: a real object, only for [probe]
  double limit = kUnset;                   // deflection limit, m; unset: the behaviour's
  // Alternative to `limit`, m: contact k of the experiment takes limit k; the last limit stays
  // (ContactLimits).
  std::vector<double> limits{};
  MaterialName material = MaterialName::unnamed;

  // Box: its edges along x, y and z of O, m; O is in its middle.
  Vec3 size{kUnset, kUnset, kUnset};

  // Mesh; a box also has rotation and surface.
  std::string mesh{};       // file
  std::string mesh_hash{};  // hash of its content, 16 hex digits; empty: unknown
  double scale = 1.0;       // factor on the file's metres
  // O in W, about the fixed x, then y, then z axis, rad.
  Vec3 rotation{0, 0, 0};
  std::shared_ptr<const Mesh> surface{};          // filled by the loader; unscaled, closed, outward
  std::optional<SurfaceMaterial> own_material{};  // filled by the loader: the mesh file's material
};

}  // namespace enc
