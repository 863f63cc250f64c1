// The inputs of a twin, the tools in it, and what it does with each machine.
#pragma once

#include <cstdint>
#include <string>

#include "core/control/scene/scene.h"
#include "sim/spec/twin_spec.h"

namespace enc::sim {

struct WorldSpec {
  const SceneSpec& scene;
  const RigSpec& rig;
  const TwinSpec& twin;
  const Scene& prepared;  // must outlive the world: the display draws its surfaces
  std::string mjcf_dir;
  std::uint64_t seed = 1;
  bool draw_all = false;
};

struct HeldTool {
  std::int32_t index = -1;  // index in the scene
  int body = -1, qpos = 0, qvel = 0;
  Vec3 tip_T, shaft_T;  // centre of its tip; from there to the markers
  double radius = kUnset;
};

class World;
// The parts of a world's cycle that differ from machine to machine.
struct MachineSteps {
  Pose<'W', 'R'> (*base)(const TwinSpec& twin);  // true pose of the machine
  void (World::*set_up)(const WorldSpec& spec);
  void (*begin_cycle)(World& world);
  void (World::*drive)(double t, double h);  // before a physics step
  void (World::*begin_work)();               // start of a physics step
  void (World::*count_work)(double h);
  void (World::*observe)();
};

// The base for which H would be W at the machine's zero, with its error: rotated about W, so that a rotation
// alone moves nothing there.
[[nodiscard]] Pose<'W', 'R'> hexapod_base(const HexapodTruth& truth);
[[nodiscard]] Pose<'W', 'R'> arm_base(const ArmTruth& truth);

}  // namespace enc::sim
