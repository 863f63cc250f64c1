// A scene: what the experiment is. These structs are the file format (models/scenes/*.toml), with its
// defaults; SI here, units in the file's keys. What a scene does not name is not built, not ticked and not
// given a thread.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/frames.h"
#include "core/mesh/mesh.h"
#include "core/response.h"
#include "core/task_spec.h"
#include "core/tip.h"

namespace enc {

enum class ShapeKind : std::uint8_t { plane, sphere, mesh };
enum class Tangential : std::uint8_t {
  stick,  // the tip stays over its contact point, whatever the sideways force (default)
  spring  // the contact point gives sideways by force / tangential_stiffness
};

// An entry of models/behaviours.toml: how a surface answers. Objects name it.
struct BehaviourSpec {
  std::string name;
  std::string response;                       // file in models/responses without ".toml"; or empty and then
  double stiffness = kUnset;                  // N/m: a linear spring, press and release alike
  double limit = kUnset;                      // deflection limit, m; unset: that of the response file
  Reversal reversal = Reversal::energy_stop;  // which of the file's models is felt
  Tangential tangential = Tangential::stick;
  double tangential_stiffness = kUnset;  // N/m, with Tangential::spring
  ResponseSpec curves;                   // filled by the loader from the response file or the stiffness
};

struct ObjectSpec {
  std::string name;
  ShapeKind shape = ShapeKind::sphere;
  double radius = kUnset;  // sphere
  Vec3 position{0, 0, 0};  // of O in W
  Vec3 normal{0, 0, 1};    // plane: outward, unit, in W
  std::string behaviour;   // by name; empty: a real thing, for [probe] alone
  double limit = kUnset;   // deflection limit, m; unset: the behaviour's
  // Instead, m: the k-th contact of the experiment takes the k-th, the last one stays (contact_limits.h).
  std::vector<double> limits{};

  // mesh
  std::string mesh{};                     // file
  std::string mesh_hash{};                // of its content, 16 hex digits; empty: not known
  double scale = 1.0;                     // of the file's metres
  Vec3 rotation{0, 0, 0};                 // of O in W, about the fixed x, then y, then z axis, rad
  std::shared_ptr<const Mesh> surface{};  // filled by the loader; unscaled, closed, outward
};

struct ToolSpec {
  std::string name;
  std::vector<Vec3> markers;  // in T
  Vec3 tip{0, 0, 0};          // centre of the tip's sphere in T
  double tip_radius = 0.002;  // 0: a point
  TipShape tip_shape = TipShape::sphere;
  Vec3 tip_axis{kUnset, kUnset, kUnset};  // in T, unit; cone: from the apex into the tool, edge: along it
  double tip_half_angle = kUnset;         // cone, rad
  double tip_edge = kUnset;               // edge: its length, m
  double mass = 0.05;                     // kg, with its markers
};

struct FollowSpec {
  double inset = 0.0005;  // how far inside the surface the tip waits, m
  double pause = 0.100;   // tool farther than this: do not travel [VHMR 3.3]
  double resume = 0.090;  // and travel again below this
};

struct ManipulatorSpec {
  std::string kind = "hexapod";
};
struct ForceSpec {};
struct TrackerSpec {};
struct DisplaySpec {};
struct GripperSpec {
  std::string tool;  // clamped, its tip at H and its shaft upwards; empty: the first
};

// What the person is asked afterwards. Nothing of it is simulated.
struct QuestionnaireSpec {
  std::string form;  // file in models/questionnaires without ".toml"
};

struct SceneSpec {
  std::int64_t format = 1;
  std::string title;
  std::vector<ObjectSpec> objects;
  std::vector<ToolSpec> tools;
  FollowSpec follow;
  std::optional<ManipulatorSpec> manipulator;
  std::optional<ForceSpec> force;
  std::optional<TrackerSpec> tracker;
  std::optional<DisplaySpec> display;
  std::optional<GripperSpec> gripper;
  std::optional<UserSpec> user;
  std::optional<ProbeSpec> probe;
  std::optional<PusherSpec> pusher;
  std::optional<TravelSpec> travel;
  std::optional<QuestionnaireSpec> questionnaire;
  std::vector<BehaviourSpec> behaviours;  // the entries of models/behaviours.toml that the objects name
};

}  // namespace enc
