// Decides whether a detection is the tip of the pointing finger. A detection is doubtful if it may be a
// thumb, a knuckle, a strip of a wall or a finger of an open hand. A doubtful detection counts as not seen.
#pragma once

#include <cstdint>

#include "core/base/frames.h"
#include "core/base/words.h"
#include "core/vision/hand/hand_form.h"

namespace enc {

// Reason to doubt a detection.
enum class Doubt : std::uint8_t {
  no,
  outline,  // no cap fits the edge of the skin
  depth,    // left and right disagree on the depth, or it is out of range
  // Its width differs from that of the scene's finger, or of the tracked one.
  size,
  // Not the form of a finger: too short, too long, without a hand behind it, or with an equally near surface
  // at its sides.
  shape,
  hand,     // as near to the palm as a thumb, or not in line with it
  fingers,  // one of three or more straight fingers of a hand
  speed,    // too fast for a hand
};
constexpr auto words(Doubt) {
  return enum_words("no", "outline", "depth", "size", "shape", "hand", "fingers", "speed");
}

// Measurements of a detection in the images, m.
struct FingerEvidence {
  bool matched = false;                         // the cap's pixels match, left and right
  bool outlined = false;                        // a cap's circle fits the edge of the skin
  double depth = kUnset, depth_noise = kUnset;  // cap's middle; rms noise
  double cap = kUnset;                          // width of the cap
  double width = kUnset, length = kUnset;       // the finger's; length is a lower bound
  double cap_slope = kUnset;                    // tangent against the image plane, by the cap's match
  double slope = kUnset;                        // that tangent by the finger behind the cap; NaN: unknown
  double hand_slope = kUnset;                   // that tangent on the way from the tip to the palm
  FormEnd end = FormEnd::nothing;
  int flanks = 0;             // four places along the finger: sides with an equally near surface
  double depth_off = kUnset;  // extra depth of the tip by the finger behind it
  Point<'C'> tip, palm;
  double hand = kUnset;  // lower bound of the distance from tip to palm
};

struct FingerLimits {
  double nearest = 0.25, farthest = 1.5;  // m
  double radius = 0.008;                  // m, of the expected finger
};

// Doubt of the finger alone, before its hand is evaluated.
[[nodiscard]] Doubt doubt_of_finger(const FingerEvidence& evidence, const FingerLimits& limits);
// Doubt by all criteria, for a detection that no earlier frame predicted.
[[nodiscard]] Doubt doubt_of(const FingerEvidence& evidence, const FingerLimits& limits);
// Doubt at the predicted position of a tracked finger whose cap was `cap` wide: it need not show its hand.
[[nodiscard]] Doubt doubt_of_followed(const FingerEvidence& evidence, const FingerLimits& limits, double cap);
// Widths from the tip to the palm: among several accepted detections, the largest value is the finger.
[[nodiscard]] double reach_of(const FingerEvidence& evidence);

}  // namespace enc
