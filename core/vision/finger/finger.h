// The fingertip of one frame, as vision tells it [VisHap 2.1.2].
#pragma once

#include <array>
#include <cstdint>

#include "core/base/frames.h"
#include "core/base/time.h"

namespace enc {

enum class FingerState : std::uint8_t {
  learning,  // the background, at every start
  away,      // no finger in view
  seen,
  predicted,  // not in this frame, but lately: what is told is the filter's
};

struct Finger {
  FingerState state = FingerState::learning;
  Time exposed{};
  Point<'C'> tip;                            // centre of the fingertip's cap, m
  Vec<'C'> velocity;                         // m/s
  Mat3 covariance = Mat3::Constant(kUnset);  // of the tip, m^2
  // The same as this frame alone shows it, before the filter. Unset unless it is seen.
  Point<'C'> shown;
  Mat3 shown_covariance = Mat3::Constant(kUnset);
  double column = kUnset, row = kUnset, disparity = kUnset;  // px, in the rectified left image
  double score = kUnset;                                     // share of skin in the circle, 0 to 1
};

}  // namespace enc
