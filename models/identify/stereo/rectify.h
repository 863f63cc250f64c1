// Quality of a calibration for a pair: the distance of a corner from the epipolar line of its partner, the
// difference of their rows once the images are rectified, and the corner's position in space. It also draws
// these pictures.
#pragma once

#include <string>
#include <vector>

#include "core/spec/vision/stereo_rig.h"
#include "models/identify/stereo/corners.h"

namespace enc {

// All results are NaN if no ray of the lens meets a corner because the distortion folds before it.
//
// px rms, in images without distortion: distances of corners from their partners' epipolar lines, both ways.
[[nodiscard]] double epipolar_error(const StereoRig& rig, const PairCorners& pair);

// px rms: row difference of a corner between the rectified images, at the smaller of the two focal lengths.
[[nodiscard]] double row_error(const StereoRig& rig, const PairCorners& pair);

// The midpoint between the two rays, m.
[[nodiscard]] std::vector<Point<'C'>> triangulated(const StereoRig& rig, const PairCorners& pair);

// A pair of images side by side, rectified by the rig, with the corners and with rows drawn through both
// images. The rows are epipolar lines: if a corner is not on one row in both, the calibration is wrong.
struct ShownPair {
  ImageView left, right;
  PairCorners corners;
  std::string words;  // text above the picture
};
[[nodiscard]] Image rectified_picture(const StereoRig& rig, const std::vector<ShownPair>& pairs);

}  // namespace enc
