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
#include "core/mesh.h"
#include "core/response.h"
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

// Who holds the tool. A simulated rig plays this; a real rig shows it to the person.
struct UserSpec {
  std::string kind = "press_release";
  std::string object;    // pressed; empty: the first
  std::string tool;      // held; empty: the first
  double azimuth = 0.0;  // where on the object, from +x towards +y of W, rad
  double polar = 0.0;    // and from +z of W, rad: 0 presses from above
  double offset = 0.0;   // sideways of the axis, m (indentation B)
  double depth = 0.006;  // wanted deflection, m
  double push = kUnset;  // instead: push with this force, N, whatever the depth
  double press_time = 6.0, hold_time = 0.5, release_time = 6.0, rest_time = 1.0;  // s
  std::vector<double> approach{0.02};  // speed of the tool when it touches, m/s; one press for each entry
  double approach_from = 0.060;        // m, distance of the start from the touched point
  double approach_tilt = 0.5;          // rad, of the approach from the surface normal
  std::int64_t repeats = 1;            // of the whole list
};

// The test rig of [VHMR 4.2, Fig 7]: the machine itself pushes a sphere into a real object and measures it.
// Nobody holds a tool, and nothing is rendered.
struct ProbeSpec {
  std::string object;     // pressed; empty: the first
  double azimuth = 0.0;   // of the axis out of the object, from +x towards +y of W, rad
  double polar = M_PI;    // and from +z of W, rad: pi is pushed from below, straight up
  double offset = 0.0;    // sideways of the axis through the object's origin, towards growing polar, m
  double radius = 0.010;  // of the sphere that the machine carries instead of its haptic-tip, m
  double depth = 0.006;   // of a push, from the first touch of the undeformed object along the axis, m
  double speed = 0.004;   // of pushing and going back, m/s
  double clear = 0.004;   // above the first touch, where a push begins and ends, m
  double dwell = 0.0;     // at depth, s
  double rest = 2.0;      // clear of the object before each push, s
  std::int64_t repeats = 5;
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
  std::vector<BehaviourSpec> behaviours;  // the entries of models/behaviours.toml that the objects name
};

}  // namespace enc
