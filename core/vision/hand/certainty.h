// Whether a find is the tip of the finger that points. A find that may be a thumb, a knuckle, a strip of a
// wall or a finger of an open hand is doubtful, and what is doubtful is not seen.
#pragma once

#include <cstdint>

#include "core/frames.h"
#include "core/text/words.h"
#include "core/vision/hand/finger_form.h"

namespace enc {

// Why a find is not believed.
enum class Doubt : std::uint8_t {
  no,
  outline,  // no cap fits the edge of the skin
  depth,    // left and right do not agree on a depth, or it is out of reach
  size,     // narrower than 8 mm, wider than 25 mm, or not as wide as the finger that is followed
  shape,    // not the form of a finger: too short, too long, no hand behind it, at its sides the same surface
  hand,     // as far from the hand as a thumb, not as a finger that points
  fingers,  // one of three or more straight fingers of a hand
  speed,    // no hand is so fast
};
constexpr auto words(Doubt) {
  return enum_words("no", "outline", "depth", "size", "shape", "hand", "fingers", "speed");
}

// Measurements of a find in the images. m
struct FingerEvidence {
  bool matched = false;                         // the cap's pixels, left and right
  bool outlined = false;                        // a cap's circle fits the edge of the skin
  double depth = kUnset, depth_noise = kUnset;  // of the middle of the cap; rms
  double cap = kUnset;                          // width of the cap
  double width = kUnset, length = kUnset;       // of the finger, its slope taken into account
  double slope = kUnset;                        // the finger's, against the image: tangent
  bool slope_known = false;                     // else it is 0
  double hand_slope = kUnset;                   // of the way from the tip to the palm; NaN: not known
  FormEnd end = FormEnd::nothing;
  int flanks = 0;             // of four places of the finger: sides where something is as near as it
  double depth_off = kUnset;  // by which the finger behind says that its tip is farther
  Point<'C'> tip, palm;
  double hand = kUnset;  // from the tip to the palm
};

struct FingerLimits {
  double nearest = 0.25, farthest = 1.5;  // m
  double radius = 0.008;                  // m, of the finger that is looked for
};

// How sure it is that a finger points, and not a thumb: how many widths it is long and how many it is away
// from the palm, less where it is wider than the finger that is looked for, and where it is seen aslant.
[[nodiscard]] double trust_of(const FingerEvidence& evidence, const FingerLimits& limits);
[[nodiscard]] Doubt doubt_of(const FingerEvidence& evidence, const FingerLimits& limits);
// The same where a followed finger is expected, whose cap was `cap` wide: it need not show its hand.
[[nodiscard]] Doubt doubt_of_followed(const FingerEvidence& evidence, const FingerLimits& limits, double cap);

}  // namespace enc
