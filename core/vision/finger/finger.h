// The fingertip of one frame, as vision measures it [VisHap 2.1.2].
#pragma once

#include <array>
#include <cstdint>

#include "core/base/frames.h"
#include "core/base/time.h"

namespace enc {

enum class FingerState : std::uint8_t {
  learning,  // learning the background, at every start
  away,      // no finger in view
  seen,
  // Not detected in this frame, but shortly before: the filter's prediction.
  predicted,
};

struct Finger {
  FingerState state = FingerState::learning;
  Time exposed{};
  Point<'C'> tip;                            // centre of the fingertip's cap, m
  Vec<'C'> velocity;                         // m/s
  Mat3 covariance = Mat3::Constant(kUnset);  // covariance of the tip, m^2
  // The tip from this frame alone, before the filter. Unset unless the state is seen.
  Point<'C'> shown;
  Mat3 shown_covariance = Mat3::Constant(kUnset);
  double column = kUnset, row = kUnset, disparity = kUnset;  // px, in the rectified left image
  double score = kUnset;                                     // share of skin in the circle, 0 to 1
};

}  // namespace enc
