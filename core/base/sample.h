// What a device says, with when it was true and how far it can be trusted.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/frames.h"
#include "core/base/joints.h"
#include "core/base/time.h"
#include "core/base/tip.h"
#include "core/base/words.h"

namespace enc {

enum class Health : std::uint8_t { absent, ok, stale, saturated, out_of_range, fault };
constexpr auto words(Health) {
  return enum_words("absent", "ok", "stale", "saturated", "out of range", "fault");
}

template <class V>
struct Stamped {
  V value{};
  Time t{};  // when it was true, not when it came
  Health health = Health::absent;
};

// Pose of a tracked tool's markers. `tool` is the index of its marker geometry in the scene, -1 where none
// was recognised.
struct TrackedTool {
  std::int32_t tool = -1;
  Pose<'C', 'T'> X_CT;
  // How well the place of T's origin is known, m rms: along the view from C to it, and to each side of that.
  // Unset, both: as well as the rig believes (rig.tracker.measurement_noise_mm).
  double along = kUnset, across = kUnset;
};

// Force and torque on the haptic-tip side of the sensor, in and about F: what the tool does to the machine.
// N, N m.
struct Wrench {
  Vec<'F'> force;
  Vec<'F'> torque;
};

// Where the machine's own encoders and set-point generator say that the haptic-tip is.
struct TipSample {
  Pose<'R', 'H'> X_RH;
  Vec<'R'> velocity;      // of the tip, m/s
  Vec<'R'> acceleration;  // of the tip, m/s^2: from the servo, not differenced; used to take inertia out of
                          // the force
};

// What a gripper is told. Closed: with which force, N, on what it clamps.
struct Grip {
  bool closed = false;
  double force = kUnset;
};
enum class GripPhase : std::uint8_t { open, closing, closed, opening };
constexpr auto words(GripPhase) { return enum_words("open", "closing", "closed", "opening"); }

struct GripSample {
  GripPhase phase = GripPhase::open;
  double opening = kUnset;  // between the jaws, m
  double force = 0.0;       // on what is clamped, N
  bool holding = false;     // closed, with something between the jaws
};

// Where an arm's encoders say that its joints are, and its tip by its own kinematics.
struct ArmSample {
  PerJoint joints{}, joint_velocities{};  // rad or m, and per s
  Point<'R'> tip;
  Vec<'R'> velocity;  // of the tip, m/s
};

// The deformed visual surface, as the renderer reports it [VHMR 3.5]: which object is dented, by what tip in
// which pose and how deep. The core evaluates the surface itself (dent.h), so Inputs stays of one size.
struct DentSample {
  std::int32_t object = -1;  // index in the scene; -1: nothing is deformed
  Tip<'O'> tip;              // of the tool, in the object's frame
  double depth =
      kUnset;  // of the tip's lowest point below the undeformed surface, m; 0 where it does not touch
};

}  // namespace enc
