// Detection and tracking of a fingertip: parts of the rig table [vision].
#pragma once

#include <cstdint>

#include "core/base/words.h"

namespace enc {

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

}  // namespace enc
