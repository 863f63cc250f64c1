// Files of calibrations: a rig's, and a stereo head's.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "core/spec/optics_rig.h"
#include "core/spec/rig_spec.h"

namespace enc::models {

// The calibration file that `encounter calibrate rig RIG --out FILE` writes and a rig's [calibration] reads.
//
//   format = 1
//   title = "Fakes of the laboratory"          # of the rig
//   date = "2026-11-28"
//
//   [of]                                       # identity of the rig; any other rig refuses it
//   manipulator = "gcs 192.168.0.20 50000"     # driver, and address and port if it has them
//   force = "netft 192.168.1.1"
//   tracker = "igtl 192.168.1.21"
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

// A stereo head as `encounter calibrate stereo FOLDER --out FILE` writes it and as a rig's camera reads it.
//
//   format = 1
//   title = "13 pairs of 640 x 480 px, board 9 x 6, squares of 25 mm"
//   width_px = 640
//   height_px = 480
//   reprojection_px = 0.19                     # residual, rms
//   epipolar_px = 0.14                         # rms, over pairs left out of the fit
//
//   [left]                                     # a pinhole: OpenCV's numbers
//   focal_px = [721.3, 721.1]                  # along rows, along columns
//   centre_px = [318.2, 241.7]                 # the centre of the first pixel is 0, 0
//   distortion = [-0.21, 0.06, 0.001, 0, 0]    # k1, k2, p1, p2, k3
//
//   [right]                                    # as [left], and its pose D in the left camera C
//   position_mm = [90.1, 0.2, -0.1]
//   rotation_deg = [0.1, -0.4, 0.0]            # about the fixed x, then y, then z axis
struct StereoFile {
  std::string title;
  StereoRig rig;                                    // width, height, lenses and X_CD
  double reprojection = kUnset, epipolar = kUnset;  // px rms
};

// Rounded to less than any calibration's accuracy: 1e-4 px, 1e-6 of distortion, 0.1 um, 1e-5 deg. A text that
// was read and written again is unchanged.
[[nodiscard]] std::string stereo_text(const StereoFile& file);

// Reads strictly, and calls check_stereo(). Every fault is an Error of one line that begins with
// file:line:column.
[[nodiscard]] StereoFile parse_stereo(const std::string& text, const std::string& name);
[[nodiscard]] StereoRig load_stereo(const std::string& path);
// True if such a file contains the scene's or rig's name: "rig.camera.left.focal_px".
[[nodiscard]] bool of_calibration(std::string_view name);

// Refuses impossible numbers: a centre outside of the image, distortion that folds the image over, a second
// camera that is not to the right of the first. Throws Error with the key of the file.
void check_stereo(const StereoRig& rig);

}  // namespace enc::models
