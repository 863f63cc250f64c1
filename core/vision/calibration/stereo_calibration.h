// A stereo head out of pictures of a chessboard: each camera by itself [Zhang 2000], then both together, and
// how well it is known: what is left over, and what a pair shows that the calibration has not seen.
#pragma once

#include <vector>

#include "core/devices/stereo_rig.h"
#include "core/vision/calibration/corners.h"

namespace enc {

struct PairResidual {
  double left = kUnset, right = kUnset;  // px rms: corners against where the calibration puts them
  // By a calibration without this pair:
  double epipolar = kUnset;  // px rms: corners from the epipolar lines of their partners, both ways
  double rows = kUnset;      // px rms: difference of the rows of a corner in the rectified images
  double square = kUnset;    // m: mean side of the squares, triangulated
  double rms = kUnset;       // px: what is left over of all the others
};

struct StereoCalibration {
  StereoRig rig;                    // of width, height, lenses and X_CD; the rest as it was
  double rms = kUnset;              // px, of all corners of both images
  double focal_deviation = kUnset;  // standard deviation of the worse focal length, as a share of it
  double tilt = kUnset;             // rad: largest angle between two boards
  std::vector<PairResidual> pairs;
  // Over all pairs, by calibrations without each:
  double epipolar = kUnset, rows = kUnset;  // px rms
};

// With more left over the pairs do not go together, and no number is worth anything: one of them is of
// another head or moment, perhaps that without which the rms is least.
inline constexpr double kLargestRms = 2.0;       // px
inline constexpr std::size_t kFewestBoards = 4;  // three, and one that is left out

// Throws Error (without a place): fewer than kFewestBoards; boards that are all parallel, which tell nothing
// of the focal length; cameras that do not stand side by side.
[[nodiscard]] StereoCalibration calibrate_stereo(const std::vector<PairCorners>& pairs, const Board& board,
                                                 int width, int height);

// How far corners are from what a rig says of a pair; left and right stay unset.
[[nodiscard]] PairResidual residual_of(const StereoRig& rig, const PairCorners& pair, const Board& board);

}  // namespace enc
