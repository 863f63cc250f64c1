// A device's sample: value, time of measurement and health.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/frames.h"
#include "core/base/time.h"
#include "core/base/tip.h"
#include "core/base/words.h"

namespace enc {

inline constexpr std::size_t kMostJoints = 3;
// One number for each joint of an arm: rad or m, N m or N. Entries beyond the machine's joints are 0.
using PerJoint = std::array<double, kMostJoints>;

enum class Health : std::uint8_t { absent, ok, stale, saturated, out_of_range, fault };
constexpr auto words(Health) {
  return enum_words("absent", "ok", "stale", "saturated", "out of range", "fault");
}

template <class V>
struct Measurement {
  V value{};
  Time t{};  // time of measurement, not of arrival
  Health health = Health::absent;
};

// Pose of a tracked tool's markers. `tool` is the index of its marker geometry in the scene; -1: no geometry
// was recognised.
struct TrackedTool {
  std::int32_t tool = -1;
  Pose<'C', 'T'> X_CT;
  // Standard uncertainty of T's origin, m rms: along the view from C to it, and across that view. If both are
  // unset, the rig's value holds (rig.tracker.measurement_noise_mm).
  double along = kUnset, across = kUnset;
};

// Force and torque on the haptic-tip side of the sensor, in and about F: the load of the tool on the machine.
// N, N m.
struct Wrench {
  Vec<'F'> force;
  Vec<'F'> torque;
};

// The haptic-tip as the machine measures and plans it: pose from the encoders, motion from the set-point
// generator.
struct TipSample {
  Pose<'R', 'H'> X_RH;
  Vec<'R'> velocity;  // tip velocity, m/s
  // Acceleration of the tip, m/s^2. The servo reports it, it is not differenced; the core uses it to take
  // inertia out of the force.
  Vec<'R'> acceleration;
};

// Command to a gripper. When closed, `force` (N) is the clamping force.
struct Grip {
  bool closed = false;
  double force = kUnset;
};
enum class GripPhase : std::uint8_t { open, closing, closed, opening };
constexpr auto words(GripPhase) { return enum_words("open", "closing", "closed", "opening"); }

struct GripSample {
  GripPhase phase = GripPhase::open;
  double opening = kUnset;  // between the jaws, m
  double force = 0.0;       // clamping force, N
  bool holding = false;     // closed, with something between the jaws
};

// Joint positions from an arm's encoders, and the tip position from the arm's kinematics.
struct ArmSample {
  PerJoint joints{}, joint_velocities{};  // rad or m, and per s
  Point<'R'> tip;
  Vec<'R'> velocity;  // tip velocity, m/s
};

// The deformed visual surface as the renderer reports it [VHMR 3.5]: the deformed object, the pose of the tip
// and its depth. The core evaluates the surface itself (dent.h), so that Inputs has a constant size.
struct DentSample {
  std::int32_t object = -1;  // index in the scene; -1: no deformation
  Tip<'O'> tip;              // the tool's tip in the object's frame
  // Depth of the tip's lowest point below the undeformed surface, m; 0 without contact.
  double depth = kUnset;
};

}  // namespace enc
