// What a fingertip is taken for, and how it is followed: parts of the rig table [vision].
#pragma once

#include <cstdint>

#include "core/base/words.h"

namespace enc {

// How far it is from the pixel p to the square S of step 6, which print has lost.
enum class SquareReading : std::uint8_t {
  // r2 is S's side, as printed: S has 4 r2 pixels, so that more than 4 r2 can never be skin, and where r2 is
  // less than 1.4 r all of S is within the finger. Any full circle then passes step 7.
  side,
  // r2 is half of S's side. The limits of step 7 are in units of r: a straight finger crosses S along 2 r
  // where it is upright, along 2.83 r through a corner. With the printed 2 r2 as the lower limit it would be
  // refused.
  half_side,
};
constexpr auto words(SquareReading) { return enum_words("side", "half_side"); }

struct FingertipSpec {
  double radius =
      0.008;           // m, R of the finger's cap (sources/tracking 7); K = f R, so that r = K / z = R d / B
  double scale = 1.0;  // of K: what a wrong radius does
  SquareReading square = SquareReading::half_side;
  double circle_share = 0.70;  // step 5: least share of skin in the circle
  double square_radii = 1.7;   // step 6: r2 / r
  double square_least = 1.4;   // step 7: least skin along S, in r; [VisHap]'s 2 is of r2
  double square_most = 4.0;    // step 7: most, in r
  double pairs = 1.0;          // step 9: most pairs of skin pixels of S that p is in the middle of
  // Ours: a candidate with more skin than this (in r) along a second square, whose half side this is (in r),
  // is taken only where there is no other. The end of a folded finger is a fingertip by all ten steps, but
  // behind it is the hand. 0: as published.
  double stretch_radii = 4.0, stretch_most = 4.5;
  double radius_least = 1.8;  // step 3, px: a smaller circle has no shape
  bool fit = true;            // the circle of the cap, else the middle of the best candidates
};

struct TrackSpec {
  double pixel_noise = 0.5;      // px rms, of the tip's place in an image
  double disparity_noise = 0.2;  // px rms, in addition to what the match says of itself
  // px/s/sqrt(s): what a hand does. 600 px/s^1.5 are 0.5 m/s/sqrt(s) at 600 mm and 721 px.
  double acceleration_noise = 1000.0;
  double disparity_acceleration_noise = 150.0;  // the same in depth
  double start_speed = 400.0;                   // px/s rms, of a finger that has just come
  double start_disparity_speed = 60.0;
  double gate = 5.0;           // sigma: a find that is farther off is not the finger
  double window_sigmas = 4.0;  // half a side of the search window, of what is foreseen
  double window_least = 24.0;  // px, half a side, at least
  double window_growth = 1.5;  // with every frame that shows no finger
  int full_frame_after = 3;    // frames without a finger: then all of the frame is searched
  double predicted_for = 0.2;  // s: so long a finger that is not seen is told from the filter
};

}  // namespace enc
