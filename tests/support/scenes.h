// Small scenes made in code, and a loop that drives step() by hand: a machine that reaches each command at
// once, an exact tracker, an exact force sensor. No MuJoCo; only tests add noise.
#pragma once

#include <functional>

#include "core/control/scene/scene.h"
#include "core/control/step.h"
#include "core/record/state_hash.h"
#include "core/spec/rig_spec.h"
#include "core/spec/scene_spec.h"

namespace enc::test {

// A linear spring with equal press and release.
[[nodiscard]] BehaviourSpec spring(double stiffness = 2000.0, double limit = 0.006);
// Near S-nominal of sources/ball 5: press 0.4 d + 1.07 d^2 - 0.22 d^3 + 0.0152 d^4 (N, mm), release 0.8 of
// it.
[[nodiscard]] BehaviourSpec lossy_ball();

// A ball of 33 mm with its top 8 mm above the machine's zero, a stylus with a tip of 2 mm, every device but a
// display.
[[nodiscard]] SceneSpec ball_scene(const BehaviourSpec& behaviour = spring());
// The half space below z = 8 mm of W.
[[nodiscard]] SceneSpec plane_scene(const BehaviourSpec& behaviour = spring());

// The test rig: a real ball of 33 mm with its centre 52 mm above W's origin. A probe of 10 mm radius presses
// it from below and first touches it at 52 - 33 - 10 = 9 mm.
[[nodiscard]] SceneSpec rig_scene();

// Two balls beside each other, and a display.
[[nodiscard]] SceneSpec two_balls(const BehaviourSpec& behaviour = lossy_ball());

// A rig for an exact tracker without delay and for tools that leap: the core takes its measurements
// unchanged.
[[nodiscard]] inline RigSpec exact_rig() {
  RigSpec rig;
  rig.tracker.prediction = Prediction::hold;
  return rig;
}

// A mesh with its origin at (0, 0, z) of W in place of the ball; the haptic-tip must fit inside.
[[nodiscard]] SceneSpec mesh_scene(Mesh mesh, double z, const Vec3& rotation = Vec3::Zero(),
                                   const BehaviourSpec& behaviour = spring());
// A polygon of the x-z plane, counter-clockwise seen from -y, extruded along y to both sides by half of
// `length`, m. A fan from the first corner triangulates `corners`, so each must be visible from there.
[[nodiscard]] Mesh prism(const std::vector<std::array<double, 2>>& corners, double length);
[[nodiscard]] Mesh box(double x, double y, double z);  // around its centre, m
// A block with a groove, 50 mm wide at its top and 35 mm deep: the nearest wall changes across it.
[[nodiscard]] Mesh groove();

inline constexpr double kTop = 0.008;         // m above W's origin, for ball and plane
inline constexpr double kBallRadius = 0.033;  // m
inline constexpr double kToolRadius = 0.002;  // m

class Loop {
 public:
  explicit Loop(Scene made);

  // State of the world; a test writes these before tick().
  Point<'W'> tool_tip{0, 0, 0.150};
  Quat tool_turn = Quat::Identity();
  std::int32_t tool = 0;
  bool tool_seen = true;
  Vec<'W'> force{0, 0, 0};             // N, of the tool on the haptic-tip
  Vec<'F'> force_zero{0, 0, 0};        // N, error of the sensor
  std::function<void(Inputs&)> spoil;  // last change of the inputs, each tick

  // Runs one tick, or several.
  const Outputs& tick(int n = 1);
  [[nodiscard]] Point<'W'> tip() const { return scene.X_WR * recall<CommandState>(state).command; }
  [[nodiscard]] Time now() const { return k.t; }

  Scene scene;
  Inputs in;
  State state;
  Outputs out;
  Tick k;

  // Maxima over all ticks so far: |v| / limit and |dv/dt| / limit of the commands, and whether all were
  // finite and reachable.
  double worst_speed = 0.0, worst_acceleration = 0.0;
  bool always_reachable = true;
  // Largest distance of the haptic-tip's outermost point to its object, m; negative: always inside.
  double worst_outside = -1.0;

 private:
  void sense();
  void judge();
  Vec3 before_ = Vec3::Zero(), velocity_ = Vec3::Zero(), acceleration_ = Vec3::Zero();
};

}  // namespace enc::test
