// The simulator's ground truth: devices, room and person, in [truth.*] of models/rigs/sim.toml. The core
// never sees it. Sources: models/schema/schema_twin.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/spec/rig_spec.h"
#include "core/spec/scene_spec.h"
#include "sim/spec/arm_spec.h"
#include "sim/spec/machine_spec.h"
#include "sim/spec/sensor_spec.h"

namespace enc::sim {

// True poses of camera and sensor. The rig file has the calibrated ones.
struct FramesTruth {
  PoseSpec W_C{{0.0, -0.9, 0.6}, {0, 0, 0}};
  PoseSpec H_F{{0.0, 0.0, -0.127}, {0, 0, 0}};
};

// Compliances at the touching point, in series: quasi-static, as far as they are visible (World::observe).
struct ContactTruth {
  double compliance = 0.0;  // m/N, tool tip and haptic-tip where they touch: their centres approach
  double flexure = 0.0;     // m/N, tool between its tip and its markers: these go on after the tip stops
};

struct HandTruth {
  double mass = 1.35;             // kg, arm endpoint and hand
  double damping = 12.0;          // N s/m
  double strength = 50.0;         // N: limit of an arm's push with a fingertip or a light tool
  double stiffness = 250.0;       // N/m
  double grip_stiffness = 700.0;  // N/m
  double grip_damping = 4.0;      // N s/m
  double integral_time = 0.05;    // s, depth loop that the person closes while pressing
  double tremor = 0.06e-3;        // m rms
  double tremor_rate = 8.1;       // Hz
  double drift = 0.15e-3;         // m rms, below 2 Hz
  double tremor_band = 4.0;       // Hz, from tremor_rate upwards, if the scene asks for a band
  // Reaches of a session. Their first part aims at this share of the path; it scatters along it and aside.
  double primary_share = 0.93, primary_scatter = 0.05,
         aside_scatter = 0.02;  // shares of the path; standard deviations
  double shortest = 0.20;       // s, a submovement
  double aborted = 0.1;         // share of reaches that turn back before the touch
  double tilt = 0.0;            // rad: amplitude of the tool's tilt about its tip
  double tilt_rate = 0.5;       // Hz, of the tilt
};

// Sets of ball_plant.h [sources/ball 4]: five that give 12 N at 6 mm, and a ball as played with.
enum class BallSet : std::uint8_t { nominal, low_loss, high_loss, vented, kpa_20, regulation };
constexpr auto words(BallSet) {
  return enum_words("nominal", "low_loss", "high_loss", "vented", "kpa_20", "regulation");
}

// The real ball that a probe presses. Unset numbers come from the set.
struct BallTruth {
  BallSet set = BallSet::nominal;
  double radius = kUnset;                                    // m; unset: from the scene
  double wall = kUnset, felt = kUnset;                       // m
  double rubber_modulus = kUnset, pressure = kUnset;         // Pa
  double felt_modulus = kUnset;                              // Pa
  double friction = kUnset, friction_travel = kUnset;        // dimensionless, m: loss inside of the ball
  std::array<double, 3> relaxing{kUnset, kUnset, kUnset};    // share of each rubber branch
  std::array<double, 3> relaxation{kUnset, kUnset, kUnset};  // s
  double uneven = 0.03;            // extra stiffness away from the poles of its z axis, as a share
  double surface_friction = 0.6;   // felt on the probe
  double surface_travel = 2.5e-3;  // m, of the probe along the surface before it slides
  Vec3 misplaced{0, 0, 0};         // ball against its place in the scene, m
};

// A row for each machine: the only place in the twin that asks which machine a scene has.
template <class Row>
struct PerMachine {
  Row hexapod, arm;
  [[nodiscard]] const Row& of(const SceneSpec& scene) const { return scene.arm ? arm : hexapod; }
};

struct TwinSpec {
  WorldTruth world;
  SolverTruth solver;
  FramesTruth frames;
  HexapodTruth hexapod;
  StructureTruth structure;
  ArmTruth arm;
  GripperTruth gripper;
  ForceTruth force;
  TrackerTruth tracker;
  CameraTruth camera;
  DisplayTruth display;
  HandTrackerTruth hand_tracker;
  ContactTruth contact;
  HandTruth hand;
  BallTruth ball;
  PusherTruth pusher;

  [[nodiscard]] bool structural() const { return hexapod.form == HexapodForm::structural; }
  // Time step and integrator: an arm, a structural hexapod and all other worlds have their own keys.
  [[nodiscard]] Stepping stepping(const SceneSpec& scene) const {
    const Stepping placed{world.timestep, world.integrator, "truth.world"},
        on_legs{structure.timestep, structure.integrator, "truth.structure"},
        jointed{arm.timestep, arm.integrator, "truth.arm"};
    return PerMachine<Stepping>{.hexapod = structural() ? on_legs : placed, .arm = jointed}.of(scene);
  }
};

}  // namespace enc::sim
