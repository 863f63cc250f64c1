// Stereo vision as the core sees it: [vision] of a rig file. A part of rig_spec.h.
#pragma once

#include <cstdint>

#include "core/base/image.h"
#include "core/base/words.h"

namespace enc {

namespace segmentation {
// Conditions for a pixel to have a hue (hue.h).
struct HueRule {
  std::uint8_t least_chroma = 12;  // out of 255; with noise of 1.5 the hue is then accurate to 0.15 rad
  std::uint8_t least_value = 16;   // out of 255, brightest channel; below it, even black has a colour
};
}  // namespace segmentation

// One Gaussian of hue [VisHap 2.1.1].
struct SkinModel {
  double hue = 0.0;     // rad, mean; the circle's 0 is red
  double spread = 0.0;  // rad, standard deviation
};

enum class SegmentationMethod : std::uint8_t { published, ours };  // tiles.h; change.h
constexpr auto words(SegmentationMethod) { return enum_words("published", "ours"); }

struct SegmentationSpec {
  SegmentationMethod method = SegmentationMethod::published;
  int background_frames = 10;  // frames averaged in RGB [VisHap 3]; 1 to 255
  int tile = 5;                // px, side [VisHap 3]; 1 to 15
  int bins = 8;                // bins of hue [VisHap 3]; 1 to 8
  double match = 0.8;          // a tile is foreground if it intersects its background's histogram by less
  double skin = 2.5;           // a pixel is skin if its hue is at most this many spreads from the mean
  double change = 4.0;  // ours: change threshold, in units of the background's noise and the light's residual
  int median = 5;       // px, side of the filter; odd, 1 to 15
  segmentation::HueRule hue;  // grey and dark pixels have no hue: alone they are not skin
  SkinModel model;
};

// Search for a block of the left image in the right one.
struct MatchSpec {
  // px, size of the block: as small as a thin finger far off, or the block sees more of the background.
  // Columns 8, 12 or 16; rows odd and at most 15.
  int columns = 8, rows = 7;
  double nearest = 0.25;  // m, nearest matched distance
  double farthest = 1.5;  // m, farthest matched distance
  // Least extra cost of the next best position, three or more pixels off, as a share; otherwise the match is
  // ambiguous.
  double uniqueness = 0.10;
  double agreement = 1.5;  // px: check from the right image back to the left; negative: no check
};

// Distance from the pixel p to the square S of step 6; the print of the paper has lost it.
enum class SquareReading : std::uint8_t {
  // r2 is S's side, as printed. S then has 4 r2 pixels, so more than 4 r2 can never be skin. For r2 below 1.4
  // r all of S is within the finger. Any full circle then passes step 7.
  side,
  // r2 is half of S's side. The limits of step 7 are in units of r: a straight finger crosses S along 2 r if
  // it is upright, along 2.83 r through a corner. The printed lower limit 2 r2 would refuse it.
  half_side,
};
constexpr auto words(SquareReading) { return enum_words("side", "half_side"); }

struct FingertipSpec {
  // m, R of the finger's cap (sources/tracking 7); K = f R, so that r = K / z = R d / B.
  double radius = 0.008;
  double scale = 1.0;  // factor on K, to study the effect of a wrong radius
  SquareReading square = SquareReading::half_side;
  double circle_share = 0.70;  // step 5: least share of skin in the circle
  double square_radii = 1.7;   // step 6: r2 / r
  double square_least = 1.4;   // step 7: least skin along S, in r; [VisHap]'s 2 is of r2
  double square_most = 4.0;    // step 7: most, in r
  double pairs = 1.0;          // step 9: most pairs of skin pixels of S that p is in the middle of
  // Our addition. A second square has the half side `stretch_radii` (in r). A candidate with more skin along
  // it than `stretch_most` (in r) is taken only if there is no other. The end of a folded finger passes all
  // ten steps as a fingertip, but the hand is behind it. 0: as published.
  double stretch_radii = 4.0, stretch_most = 4.5;
  double radius_least = 1.8;  // step 3, px: a smaller circle has no recognisable shape
  bool fit = true;            // fit the circle of the cap, else use the middle of the best candidates
};

struct TrackSpec {
  double pixel_noise = 0.5;      // px rms, of the tip's position in an image
  double disparity_noise = 0.2;  // px rms, in addition to the match's own uncertainty
  // px/s/sqrt(s): the hand's motion. 600 px/s^1.5 are 0.5 m/s/sqrt(s) at 600 mm and 721 px.
  double acceleration_noise = 1000.0;
  double disparity_acceleration_noise = 150.0;  // the hand's motion in depth
  double start_speed = 400.0;                   // px/s rms, of a newly detected finger
  double start_disparity_speed = 60.0;
  double gate = 5.0;           // sigma: a detection farther off is not the finger
  double window_sigmas = 4.0;  // half a side of the search window, in sigma of the prediction
  double window_least = 24.0;  // px, smallest half side
  double window_growth = 1.5;  // growth factor with every frame without a finger
  int full_frame_after = 3;    // frames without a finger; then the whole frame is searched
  double predicted_for = 0.2;  // s: longest time for which the filter predicts an undetected finger
};

// The ball that replaces the arm's tip during the registration of camera and arm.
struct BallSpec {
  double radius = 0.012;          // m
  double hue = 6.11;              // rad: a red beside purple, which is rare in skin and in rooms
  double hue_within = 0.26;       // rad, either way
  double least_saturation = 0.5;  // least saturation of its pixels: chroma over the brightest channel
};

struct VisionRig {
  SegmentationSpec segmentation;
  FingertipSpec fingertip;
  TrackSpec track;
  MatchSpec match;
  BallSpec ball;
  // Search region for an untracked finger, px of the rectified left image; empty: everywhere. A tracked
  // finger may leave it.
  Region search;
};

}  // namespace enc
