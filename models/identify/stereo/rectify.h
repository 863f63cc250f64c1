// What a calibration says of a pair: whether a corner lies on the epipolar line of its partner, whether both
// are on one row once the images are rectified, and where it is in space. And the pictures that show it.
#pragma once

#include <string>
#include <vector>

#include "core/spec/vision/stereo_rig.h"
#include "models/identify/stereo/corners.h"

namespace enc {

// Where no ray of the lens meets a corner, because its distortion folds before, these are NaN.
//
// px rms, in images without distortion: distances of corners from their partners' epipolar lines, both ways.
[[nodiscard]] double epipolar_error(const StereoRig& rig, const PairCorners& pair);

// px rms: difference of the rows of a corner in the rectified images, whose focal length is the smaller one.
[[nodiscard]] double row_error(const StereoRig& rig, const PairCorners& pair);

// By the middle between the two rays, m.
[[nodiscard]] std::vector<Point<'C'>> triangulated(const StereoRig& rig, const PairCorners& pair);

// A pair of images side by side as the rig rectifies them, with rows drawn through both, which are epipolar
// lines, and the corners on them. Where corners are not on one row in both, the calibration is wrong.
struct ShownPair {
  ImageView left, right;
  PairCorners corners;
  std::string words;  // over the picture
};
[[nodiscard]] Image rectified_picture(const StereoRig& rig, const std::vector<ShownPair>& pairs);

}  // namespace enc
