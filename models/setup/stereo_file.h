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
#pragma once

#include <string>
#include <string_view>

#include "core/spec/vision/stereo_rig.h"

namespace enc::models {

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
