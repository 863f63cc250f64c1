// A rig as the core sees it: the driver of each role, the calibrated poses of the devices, and the numbers of
// the haptic loop. These structs are the file format (models/rigs/*.toml). The simulator's ground truth is
// separate (sim/spec/twin_spec.h), so that a wrong calibration can be injected and measured.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "core/base/words.h"
#include "core/machine/hexapod.h"
#include "core/spec/optics_rig.h"
#include "core/spec/rendering_rig.h"
#include "core/spec/settings.h"
#include "core/spec/vision_rig.h"

namespace enc {

// A pose in a file: position, and rotation about the fixed x, then y, then z axis of the parent, rad.
struct PoseSpec {
  Vec3 position{0, 0, 0};
  Vec3 rotation{0, 0, 0};
};

struct LoopRig {
  double rate = 1000.0;          // Hz [VHMR 2]
  std::int64_t late_cycles = 5;  // missed cycles that cause a hold
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
  std::string file;  // the file of `encounter calibrate rig`, beside the rig file; empty: the numbers here
  std::string date;  // measuring date of frames, geometry and force sensor, "2026-11-27"; empty: never
  std::int64_t valid = 30;  // days after `date` in which a real machine may be armed
};

struct ManipulatorRig {
  std::string driver = "sim";
  HexapodGeometry geometry;
  double speed = 0.050;        // commands, m/s [VHMR 2]
  double acceleration = 0.41;  // commands, m/s^2 (sources/hexapod 4)
  double payload = 98.1;       // N: 10 kg, the machine's load plus the pressing force [VHMR 2]
  double tip_radius = 0.005;   // m, radius of the haptic-tip's sphere; H is its centre
  // The tip's mount from below, symmetric about H's z: a stem, then gripper and sensor, then the platform.
  double stem_radius = 0.004;      // m
  double stem_length = 0.040;      // m, from H down to the gripper
  double gripper_radius = 0.0377;  // m, gripper and sensor: the sensor's radius (sources/force_sensor 1)
  double servo = 15.0;             // natural frequency of the machine's response, Hz
  double servo_damping = 0.8;      // damping ratio
  double delay = 0.004;            // dead time, s; the three set the softest object (loop_model.h)
};

enum class Tare : std::uint8_t {
  start,  // once, before the first touch, as the paper's rig does
  free,   // then slowly again whenever the tool is clear of the object
  window  // anew from each whole tare_time with the tool clear, except the last one before a touch
};
constexpr auto words(Tare) { return enum_words("start", "free", "window"); }

struct ForceRig {
  std::string driver = "sim";
  double filter = 5.0;      // low-pass corner, Hz (sources/hexapod 4)
  double threshold = 0.05;  // N, subtracted from the pressing force (sources/force_sensor 3)
  double contact = 0.10;    // N, pressing force that counts as a contact
  double mass = 0.91;       // kg, behind the sensor (gripper, adapters, tip)
  Tare tare = Tare::free;
  double tare_time = 0.2;         // s, of the first zero; 0: use the sensor's own zero
  double tare_clearance = 0.003;  // m of gap
  double stale = 0.005;           // s
};

struct GripperRig {
  std::string driver = "sim";
  double force = 100.0;  // clamping force, N
};

struct ContactRig {
  double leave_gap = 0.0010;  // m: the contact ends at a larger gap without force for leave_time
  double leave_time = 0.050;  // s
  double restored = 4e-6;     // m: back at the buffered point (the machine steps by 3e-6)
  // N/m and hand_damping N s/m: the operator at the loop's limit frequency (sources/hand 1).
  double hand_stiffness = 700.0;
  double hand_damping = 4.0;
  // N/m: minimum stiffness of an object; unset: the stable limit with that hand (loop_model.h), 0: no limit.
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
  HandTrackerRig hand_tracker;
  ContactRig contact;
  AdmittanceRig admittance;
  std::vector<DriverTable> drivers;  // sorted by name
};

}  // namespace enc
