// A stereo head out of pictures of a chessboard: each camera by itself [Zhang 2000], then both together, and
// how well it is known: what is left over, and what a pair shows that the calibration has not seen.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/spec/vision/stereo_rig.h"
#include "models/identify/stereo/corners.h"

namespace enc {

struct PairResidual {
  double left = kUnset, right = kUnset;  // px rms: corners against where the calibration puts them
  // By a calibration without this pair:
  double epipolar = kUnset;  // px rms: corners from the epipolar lines of their partners, both ways
  double rows = kUnset;      // px rms: difference of the rows of a corner in the rectified images
  double square = kUnset;    // m: side of the squares of the board that fits the triangulated corners best
  double rms = kUnset;       // px: what is left over of all the others
};

// How a lens fits the corners of its images, both cameras apart.
struct LensFit {
  double rms = kUnset;    // px
  double reach = kUnset;  // how far out the corners lie, as a share of the way from the axis to the image's
                          // farthest corner
  // Of the eight rings of as many corners each the one where they lie farthest outwards (negative: inwards)
  // from where the lens has them, in the mean:
  double outwards = kUnset;            // px
  double outwards_deviation = kUnset;  // px, standard deviation of that mean
  double ring = kUnset;                // its place, as reach

  // The lens is not of this model: a ring lies off by more than chance and a tenth of a pixel, or all corners
  // by half a pixel, for which a bent board is a reason, too.
  [[nodiscard]] bool unlike() const {
    return rms > 0.5 || (std::abs(outwards) > 0.1 && std::abs(outwards) > 5.0 * outwards_deviation);
  }
};

// It bends the edge of an image alone, and often cannot be told.
enum class K3 : std::uint8_t {
  zero,    // no more of it is seen than chance would show
  fitted,  // that of one lens is more than three standard deviations from 0
  folds,   // likewise, but with it a lens folds before the image's corner, so that both are 0
};

struct StereoCalibration {
  StereoRig rig;  // of width, height, lenses and X_CD; the rest as it was
  LensFit left, right;
  K3 k3 = K3::zero;
  double rms = kUnset;              // px, of all corners of both images
  double focal_deviation = kUnset;  // standard deviation of the worse focal length, as a share of it
  double tilt = kUnset;             // rad: largest angle between two boards
  std::vector<PairResidual> pairs;
  // Over all pairs, by calibrations without each:
  double epipolar = kUnset, rows = kUnset;  // px rms
};

// With more left over no number is worth anything. Where each camera alone fits, the pairs do not go
// together: one of them is of another head or moment, perhaps that without which the rms is least.
inline constexpr double kLargestRms = 2.0;       // px
inline constexpr double kLoosestFocal = 0.05;    // share of a focal length that its deviation may be
inline constexpr std::size_t kFewestBoards = 4;  // three, and one that is left out

// Throws Error (without a place): fewer than kFewestBoards; boards that are all parallel, which tell nothing
// of the focal length; cameras that do not stand side by side, unless the lenses do not fit either.
[[nodiscard]] StereoCalibration calibrate_stereo(const std::vector<PairCorners>& pairs, const Board& board,
                                                 int width, int height);

// How far corners are from what a rig says of a pair; left and right stay unset.
[[nodiscard]] PairResidual residual_of(const StereoRig& rig, const PairCorners& pair, const Board& board);

}  // namespace enc
