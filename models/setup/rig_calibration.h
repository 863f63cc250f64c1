// What `encounter calibrate rig RIG --out FILE` writes and a rig's [calibration] reads.
//
//   format = 1
//   title = "Fakes of the laboratory"          # of the rig
//   date = "2026-11-28"
//
//   [of]                                       # which rig it is of: of another one it is refused
//   manipulator = "gcs 192.168.0.10 50000"     # driver, address and port where it has them
//   force = "netft 192.168.0.11"
//   tracker = "igtl 192.168.0.12"
//   [of.geometry]                              # of the machine, as [manipulator.geometry]
//
//   [frames.W_C]                               # tracker camera in the world
//   position_mm = [0.1, -899.8, 600.2]
//   rotation_deg = [0.01, 0.02, -0.01]
//   [frames.H_F]                               # force sensor under the haptic-tip
//   rotation_deg = [0.1, -0.2, 1.9]
//   [force]
//   mass_kg = 0.912                            # behind the sensor, without the tool
//
// Each table of what is measured is there only if it was; a rig takes a file that has all that it has itself.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "core/spec/rig_spec.h"

namespace enc::models {

// What makes a rig this rig. Where a role is simulated or missing, its driver says so.
struct RigIdentity {
  std::string manipulator, force, tracker;
  HexapodGeometry geometry;
};
[[nodiscard]] RigIdentity identity_of(const RigSpec& rig);

struct RigCalibration {
  std::string title, date;
  RigIdentity of;
  std::optional<PoseSpec> W_C;
  std::optional<Vec3> H_F;     // rotation, rad, about the fixed x, then y, then z axis
  std::optional<double> mass;  // kg
};

// Rounded to what no calibration knows: 0.1 um, 1e-5 deg, 0.1 g.
[[nodiscard]] std::string rig_calibration_text(const RigCalibration& calibration);
// Every mistake is an Error of one line that begins with file:line:column.
[[nodiscard]] RigCalibration parse_rig_calibration(const std::string& text, const std::string& name);

// "2026-11-28" as a day; nothing where it is none.
[[nodiscard]] std::optional<std::chrono::sys_days> day_of(std::string_view text);

// What is wrong with the day on which a rig was measured, UTC; empty: nothing. It may be tomorrow's where the
// rig was measured east of here.
[[nodiscard]] std::string doubt_of(const CalibrationRig& calibration, std::chrono::sys_days today);

// Whether such a file says what --set calls so: "rig.force.mass_kg".
[[nodiscard]] bool of_rig_calibration(std::string_view name);

}  // namespace enc::models
