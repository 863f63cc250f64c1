// A stereo head from pictures of a chessboard: each camera by itself [Zhang 2000], then both together, with
// uncertainties: the residual, and the error of each pair in a calibration without it.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/spec/optics_rig.h"
#include "models/identify/stereo/corners.h"

namespace enc {

struct PairResidual {
  double left = kUnset, right = kUnset;  // px rms: corners against the calibration's prediction
  // Values from a calibration without this pair:
  // px rms: corners to the epipolar lines of their partners, both ways.
  double epipolar = kUnset;
  // px rms: row difference of a corner between the rectified images.
  double rows = kUnset;
  double square = kUnset;  // m: best-fitting square size of the triangulated board
  double rms = kUnset;     // px: residual of all the other pairs
};

// Fit of a lens to the corners of its images, for each camera alone.
struct LensFit {
  double rms = kUnset;  // px
  // Outermost corner, as a share of the way from the axis to the image's farthest corner.
  double reach = kUnset;
  // Eight rings hold equally many corners each. These values belong to the ring whose corners lie farthest
  // outwards (negative: inwards) from the lens model, on average:
  double outwards = kUnset;            // px
  double outwards_deviation = kUnset;  // px, standard deviation of that mean
  double ring = kUnset;                // position of the ring, in the unit of `reach`

  // True if the lens does not follow this model: a ring is off by more than chance and a tenth of a pixel, or
  // all corners by half a pixel. A bent board can cause the latter too.
  [[nodiscard]] bool unlike() const {
    return rms > 0.5 || (std::abs(outwards) > 0.1 && std::abs(outwards) > 5.0 * outwards_deviation);
  }
};

// k3 bends only the edge of an image, and often cannot be determined.
enum class K3 : std::uint8_t {
  zero,  // not significant
  // One lens differs from 0 by more than three standard deviations.
  fitted,
  // Significant, but a lens would fold before the image's corner, so both are 0.
  folds,
};

struct StereoCalibration {
  StereoRig rig;  // new width, height, lenses and X_CD; the rest is unchanged
  LensFit left, right;
  K3 k3 = K3::zero;
  double rms = kUnset;  // px, all corners of both images
  // Standard deviation of the worse focal length, as a share of it.
  double focal_deviation = kUnset;
  double tilt = kUnset;  // rad: largest angle between two boards
  std::vector<PairResidual> pairs;
  // Over all pairs, each by a calibration without it:
  double epipolar = kUnset, rows = kUnset;  // px rms
};

// A larger residual makes every number worthless. If each camera alone fits, the pairs do not belong
// together: one is from another head or moment, perhaps the one without which the rms is least.
inline constexpr double kLargestRms = 2.0;       // px
inline constexpr double kLoosestFocal = 0.05;    // largest standard deviation, as a share of the focal length
inline constexpr std::size_t kFewestBoards = 4;  // three, and one that is left out

// Throws Error (without a place): fewer than kFewestBoards; boards that are all parallel, which do not
// determine the focal length; cameras that are not side by side, unless the lenses do not fit either.
[[nodiscard]] StereoCalibration calibrate_stereo(const std::vector<PairCorners>& pairs, const Board& board,
                                                 int width, int height);

// Distance of the corners from a rig's prediction for a pair; left and right stay unset.
[[nodiscard]] PairResidual residual_of(const StereoRig& rig, const PairCorners& pair, const Board& board);

// Quality of a calibration for a pair: the distance of a corner from the epipolar line of its partner, the
// difference of their rows once the images are rectified, and the corner's position in space. It also draws
// these pictures.
//
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
