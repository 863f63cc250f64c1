// Small scenes made in code, and a loop that drives step() by hand: a machine that is where it was told to
// be, an exact tracker, an exact force sensor. No MuJoCo, no noise but what a test adds.
#pragma once

#include <functional>

#include "core/control/scene/scene.h"
#include "core/control/step.h"
#include "core/record/state_hash.h"
#include "core/spec/rig_spec.h"
#include "core/spec/scene_spec.h"

namespace enc::test {

// Linear spring, press and release alike.
[[nodiscard]] BehaviourSpec spring(double stiffness = 2000.0, double limit = 0.006);
// Near S-nominal of sources/ball 5: press 0.4 d + 1.07 d^2 - 0.22 d^3 + 0.0152 d^4 (N, mm), release 0.8 of
// it.
[[nodiscard]] BehaviourSpec lossy_ball();

// Ball of 33 mm with its top 8 mm above the machine's zero, a stylus with a tip of 2 mm, everything but a
// display.
[[nodiscard]] SceneSpec ball_scene(const BehaviourSpec& behaviour = spring());
// Half space below z = 8 mm of W.
[[nodiscard]] SceneSpec plane_scene(const BehaviourSpec& behaviour = spring());

// The test rig: a real ball of 33 mm with its centre 52 mm above W's origin, pressed from below by a probe of
// 10 mm radius, which first touches it at 52 - 33 - 10 = 9 mm.
[[nodiscard]] SceneSpec rig_scene();

// Two balls beside each other, and a display.
[[nodiscard]] SceneSpec two_balls(const BehaviourSpec& behaviour = lossy_ball());

// For a tracker that is exact and never late, and tools that leap: what it says is taken as it is.
[[nodiscard]] inline RigSpec exact_rig() {
  RigSpec rig;
  rig.tracker.prediction = Prediction::hold;
  return rig;
}

// A mesh with its origin at (0, 0, z) of W in place of the ball; the haptic-tip must have room in it.
[[nodiscard]] SceneSpec mesh_scene(Mesh mesh, double z, const Vec3& rotation = Vec3::Zero(),
                                   const BehaviourSpec& behaviour = spring());
// A polygon of the x-z plane, counter-clockwise seen from -y, drawn out along y to both sides by half of
// `length`, m. `corners` are triangulated as a fan from the first, so each must be seen from there.
[[nodiscard]] Mesh prism(const std::vector<std::array<double, 2>>& corners, double length);
[[nodiscard]] Mesh box(double x, double y, double z);  // around its middle, m
// A block with a groove, 50 mm wide at its top and 35 mm deep: across it the nearest wall changes.
[[nodiscard]] Mesh groove();

inline constexpr double kTop = 0.008;         // m, of ball and plane above W's origin
inline constexpr double kBallRadius = 0.033;  // m
inline constexpr double kToolRadius = 0.002;  // m

class Loop {
 public:
  explicit Loop(Scene made);

  // Where and what the world is; a test writes these before tick().
  Point<'W'> tool_tip{0, 0, 0.150};
  Quat tool_turn = Quat::Identity();
  std::int32_t tool = 0;
  bool tool_seen = true;
  Vec<'W'> force{0, 0, 0};             // of the tool on the haptic-tip, N
  Vec<'F'> force_zero{0, 0, 0};        // error of the sensor, N
  std::function<void(Inputs&)> spoil;  // last change of the inputs, each tick

  // One tick, or several.
  const Outputs& tick(int n = 1);
  [[nodiscard]] Point<'W'> tip() const { return scene.X_WR * recall<CommandState>(state).command; }
  [[nodiscard]] Time now() const { return k.t; }

  Scene scene;
  Inputs in;
  State state;
  Outputs out;
  Tick k;

  // Over all ticks so far: largest |v| / limit and |dv/dt| / limit of the commands, and whether all were
  // finite and reachable.
  double worst_speed = 0.0, worst_acceleration = 0.0;
  bool always_reachable = true;
  // Largest distance of the haptic-tip's outermost point to the object it is at, m; negative: always inside.
  double worst_outside = -1.0;

 private:
  void sense();
  void judge();
  Vec3 before_ = Vec3::Zero(), velocity_ = Vec3::Zero(), acceleration_ = Vec3::Zero();
};

}  // namespace enc::test
