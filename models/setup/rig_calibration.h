// The calibration file that `encounter calibrate rig RIG --out FILE` writes and a rig's [calibration] reads.
//
//   format = 1
//   title = "Fakes of the laboratory"          # of the rig
//   date = "2026-11-28"
//
//   [of]                                       # identity of the rig; any other rig refuses it
//   manipulator = "gcs 192.168.0.10 50000"     # driver, and address and port if it has them
//   force = "netft 192.168.0.11"
//   tracker = "igtl 192.168.0.12"
//   [of.geometry]                              # the machine's, as [manipulator.geometry]
//
//   [frames.W_C]                               # tracker camera in the world
//   position_mm = [0.1, -899.8, 600.2]
//   rotation_deg = [0.01, 0.02, -0.01]
//   [frames.H_F]                               # force sensor under the haptic-tip
//   rotation_deg = [0.1, -0.2, 1.9]
//   [force]
//   mass_kg = 0.912                            # behind the sensor, without the tool
//
// A table exists only if its values were measured; a rig accepts a file with all tables that the rig has.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "core/spec/rig_spec.h"

namespace enc::models {

// The identity of a rig. The driver field also marks a simulated or missing role.
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

// Rounded to less than any calibration's accuracy: 0.1 um, 1e-5 deg, 0.1 g.
[[nodiscard]] std::string rig_calibration_text(const RigCalibration& calibration);
// Every fault is an Error of one line that begins with file:line:column.
[[nodiscard]] RigCalibration parse_rig_calibration(const std::string& text, const std::string& name);

// "2026-11-28" as a day; empty if it is not a day.
[[nodiscard]] std::optional<std::chrono::sys_days> day_of(std::string_view text);

// The problem with the day on which a rig was measured, UTC; empty: no problem. The day may be tomorrow's if
// the rig was measured farther east.
[[nodiscard]] std::string doubt_of(const CalibrationRig& calibration, std::chrono::sys_days today);

// True if such a file contains the --set name: "rig.force.mass_kg".
[[nodiscard]] bool of_rig_calibration(std::string_view name);

}  // namespace enc::models
