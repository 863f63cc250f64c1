// A rig, as the core sees it: which driver fills each role, where the devices stand (the calibration that is
// *believed*), and the numbers the haptic loop works with. These structs are the file format
// (models/rigs/*.toml). The simulator's truth is apart (sim/spec/twin_spec.h), so that a wrong calibration
// can be injected and measured.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "core/base/words.h"
#include "core/machine/hexapod.h"
#include "core/spec/admittance_rig.h"
#include "core/spec/arm_rig.h"
#include "core/spec/display_rig.h"
#include "core/spec/settings.h"
#include "core/spec/tracker_rig.h"
#include "core/spec/vision/stereo_rig.h"
#include "core/spec/vision/vision_rig.h"

namespace enc {

// A pose in a file: position, and rotation about the fixed x, then y, then z axis of the parent, rad.
struct PoseSpec {
  Vec3 position{0, 0, 0};
  Vec3 rotation{0, 0, 0};
};

struct LoopRig {
  double rate = 1000.0;          // Hz [VHMR 2]
  std::int64_t late_cycles = 5;  // missed cycles that mean "hold"
};

// The constant poses of [VHMR Fig 4]. X_WR follows from "X_WH is the identity at the machine's zero" and has
// no entry.
struct FramesRig {
  PoseSpec W_S{{-0.6, 0.0, 0.3}, {0, 0, 0}};
  PoseSpec W_C{{0.0, -0.9, 0.6}, {0, 0, 0}};
  PoseSpec G_L{{0.0, 0.08, 0.0}, {0, 0, 0}};
  PoseSpec H_F{{0.0, 0.0, -0.127}, {0, 0, 0}};
};

struct CalibrationRig {
  std::string file;  // of `encounter calibrate rig`, beside the rig's; empty: what the rig file says is so
  std::string date;  // on which frames, geometry and force sensor were measured, "2026-11-27"; empty: never
  std::int64_t valid = 30;  // days from then on, in which a real machine is armed
};

struct ManipulatorRig {
  std::string driver = "sim";
  HexapodGeometry geometry;
  double speed = 0.050;        // of commands, m/s [VHMR 2]
  double acceleration = 0.41;  // of commands, m/s^2 (sources/hexapod 4)
  double payload = 98.1;       // N: 10 kg, what it carries and is pressed with, together [VHMR 2]
  double tip_radius = 0.005;   // of the haptic-tip's sphere, m; H is its centre
  // What carries the tip from below, round about H's z: a stem, then gripper and sensor, then the platform.
  double stem_radius = 0.004;      // m
  double stem_length = 0.040;      // from H down to the gripper, m
  double gripper_radius = 0.0377;  // of gripper and sensor, m: that of the sensor (sources/force_sensor 1)
  double servo = 15.0;             // what the rig is believed to answer with: natural frequency, Hz,
  double servo_damping = 0.8;      // damping ratio
  double delay = 0.004;            // and dead time, s; they set how soft an object may be (loop_model.h)
};

enum class Tare : std::uint8_t {
  start,  // once, before the first touch, as the paper's rig does
  free,   // and slowly again whenever the tool is clear of the object
  window  // and anew from each whole tare_time in which it is clear, but for the last one before a touch
};
constexpr auto words(Tare) { return enum_words("start", "free", "window"); }

struct ForceRig {
  std::string driver = "sim";
  double filter = 5.0;      // corner of the low-pass, Hz (sources/hexapod 4)
  double threshold = 0.05;  // taken off the pressing force, N (sources/force_sensor 3)
  double contact = 0.10;    // pressing force that is a contact, N
  double mass = 0.91;       // behind the sensor (gripper, adapters, tip), kg
  Tare tare = Tare::free;
  double tare_time = 0.2;         // s, of the first zero; 0: the sensor's own zero is believed
  double tare_clearance = 0.003;  // m of gap
  double stale = 0.005;           // s
};

struct GripperRig {
  std::string driver = "sim";
  double force = 100.0;  // N, to clamp with
};

struct ContactRig {
  double leave_gap = 0.0010;  // m: the tool is away when the gap is larger and no force has been felt for
  double leave_time = 0.050;  // s
  double restored = 4e-6;     // m: back at the buffered point (the machine steps by 3e-6)
  double hand_stiffness =
      700.0;  // N/m, hand_damping N s/m: of the person at the loop's limit frequency (sources/hand 1)
  double hand_damping = 4.0;
  // N/m: softer objects are refused; unset: what that hand makes unstable (loop_model.h), 0: none is refused
  double softest = kUnset;
};

struct RigSpec {
  std::int64_t format = 1;
  std::string title;
  LoopRig loop;
  CalibrationRig calibration;
  FramesRig frames;
  ManipulatorRig manipulator;
  ArmRig arm;
  ForceRig force;
  TrackerRig tracker;
  StereoRig camera;
  VisionRig vision;
  DisplayRig display;
  GripperRig gripper;
  ContactRig contact;
  AdmittanceRig admittance;
  std::vector<DriverTable> drivers;  // by name
};

}  // namespace enc
