// A scene: what the experiment is. These structs are the file format (models/scenes/*.toml), with its
// defaults; SI here, units in the file's keys. What a scene does not name is not built, not ticked and not
// given a thread. What only one task needs is a part of its own (probe_spec.h, travel_spec.h).
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
#include "core/spec/probe_spec.h"
#include "core/spec/travel_spec.h"
#include "core/spec/user_spec.h"

namespace enc {

struct ToolSpec {
  std::string name;
  std::vector<Vec3> markers{};  // in T
  Vec3 tip{0, 0, 0};            // centre of the tip's sphere in T
  double tip_radius = 0.002;    // 0: a point
  TipShape tip_shape = TipShape::sphere;
  Vec3 tip_axis{kUnset, kUnset, kUnset};  // in T, unit; cone: from the apex into the tool, edge: along it
  double tip_half_angle = kUnset;         // cone, rad
  double tip_edge = kUnset;               // edge: its length, m
  double mass = 0.05;                     // kg, with its markers
};

struct FollowSpec {
  double inset = 0.0005;      // how far inside the surface the tip waits, m
  double pause = 0.100;       // tool farther than this: do not travel [VHMR 3.3]
  double resume = 0.090;      // and travel again below this
  double hysteresis = 0.001;  // another object must be nearer by this to take over, m
  double ahead = 0.0;         // s: the nearest object is that of where the tool will be by then
};

// Which machine carries the haptic-tip.
enum class ManipulatorKind : std::uint8_t { hexapod };
constexpr auto words(ManipulatorKind) { return enum_words("hexapod"); }
struct ManipulatorSpec {
  ManipulatorKind kind = ManipulatorKind::hexapod;
};
struct ArmSpec {};  // which one, the rig says
// What the arm carries at its tip [VisHap 2]: a thing with a front that the finger touches.
struct PropSpec {
  PropKind kind = PropKind::plate;
  double mass = 0.020;           // kg
  Vec3 size{0.03, 0.03, 0.002};  // along x and y of its front, and behind it, m
};
struct ForceSpec {};
struct TrackerSpec {};
struct CameraSpec {};  // the tracker looks through a stereo camera, which the rig says
struct DisplaySpec {};
struct GripperSpec {
  std::string tool;  // clamped, its tip at H and its shaft upwards; empty: the first
};

// What the person is asked afterwards. Nothing of it is simulated.
struct QuestionnaireSpec {
  std::string form;  // file in models/questionnaires without ".toml"
};

struct SceneSpec : ProbePart, TravelPart {
  std::int64_t format = 1;
  std::string title;
  std::string rig;  // in models/rigs, that it is made for; empty: "sim"
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
  std::optional<UserSpec> user;
  std::optional<PusherSpec> pusher;
  std::optional<QuestionnaireSpec> questionnaire;
  std::vector<BehaviourSpec> behaviours;  // the entries of models/behaviours.toml that the objects name
};

}  // namespace enc
