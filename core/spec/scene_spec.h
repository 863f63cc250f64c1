// A scene: the definition of the experiment. These structs are the file format (models/scenes/*.toml), with
// its defaults; SI here, units in the file's keys. A device that the scene does not name is not built, not
// ticked and gets no thread. Keys of a single task are a part of their own (task_spec.h).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "core/base/tip.h"
#include "core/base/words.h"
#include "core/spec/object_spec.h"
#include "core/spec/task_spec.h"
#include "core/spec/user_spec.h"

namespace enc {

struct ToolSpec {
  std::string name;
  std::vector<Vec3> markers{};  // in T
  Vec3 tip{0, 0, 0};            // centre of the tip's sphere in T
  double tip_radius = 0.002;    // 0: a point
  TipShape tip_shape = TipShape::sphere;
  // Unit, in T. Cone: from the apex into the tool; edge: along it.
  Vec3 tip_axis{kUnset, kUnset, kUnset};
  double tip_half_angle = kUnset;  // cone, rad
  double tip_edge = kUnset;        // edge: length, m
  double mass = 0.05;              // kg, including markers
};

struct FollowSpec {
  double inset = 0.0005;      // m, depth of the waiting tip below the surface
  double pause = 0.100;       // m, tool farther than this: do not travel [VHMR 3.3]
  double resume = 0.090;      // m, tool nearer than this: travel again
  double hysteresis = 0.001;  // m, another object must be nearer by this to take over
  double ahead = 0.0;         // s: the nearest object is chosen for the tool's position by then
};

// The machine that carries the haptic-tip.
enum class ManipulatorKind : std::uint8_t { hexapod };
constexpr auto words(ManipulatorKind) { return enum_words("hexapod"); }
struct ManipulatorSpec {
  ManipulatorKind kind = ManipulatorKind::hexapod;
};
struct ArmSpec {};  // the rig defines the arm
// The prop at the arm's tip [VisHap 2]: a body with a front that the finger touches.
struct PropSpec {
  PropKind kind = PropKind::plate;
  double mass = 0.020;  // kg
  // Along x and y of its front, and behind it, m.
  Vec3 size{0.03, 0.03, 0.002};
};
struct ForceSpec {};
struct TrackerSpec {};
struct CameraSpec {};  // the tracker uses the rig's stereo camera
struct DisplaySpec {};
struct HandTrackerSpec {};
struct GripperSpec {
  // Clamped, its tip at H and its shaft upwards; empty: the first.
  std::string tool;
};

// Questions to the person after the experiment; they are not simulated.
struct QuestionnaireSpec {
  std::string form;  // file in models/questionnaires without ".toml"
};

struct SceneSpec : ProbePart, TravelPart {
  std::int64_t format = 1;
  std::string title;
  // Rig in models/rigs that the scene is made for; empty: "sim".
  std::string rig;
  std::vector<ObjectSpec> objects;
  std::vector<ToolSpec> tools;
  FollowSpec follow;
  std::optional<ManipulatorSpec> manipulator;
  std::optional<ArmSpec> arm;
  std::optional<PropSpec> prop;
  std::optional<ForceSpec> force;
  std::optional<TrackerSpec> tracker;
  std::optional<CameraSpec> camera;
  std::optional<DisplaySpec> display;
  std::optional<GripperSpec> gripper;
  std::optional<HandTrackerSpec> hand_tracker;
  std::optional<UserSpec> user;
  std::optional<PusherSpec> pusher;
  std::optional<QuestionnaireSpec> questionnaire;
  std::vector<BehaviourSpec> behaviours;  // the entries of models/behaviours.toml that the objects name
};

}  // namespace enc
