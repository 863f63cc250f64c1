// Whether a find is the tip of the finger that points. A find that may be a thumb, a knuckle, a strip of a
// wall or a finger of an open hand is doubtful, and what is doubtful is not seen.
#pragma once

#include <cstdint>

#include "core/base/frames.h"
#include "core/base/words.h"
#include "core/vision/hand/finger_form.h"

namespace enc {

// Why a find is not believed.
enum class Doubt : std::uint8_t {
  no,
  outline,  // no cap fits the edge of the skin
  depth,    // left and right do not agree on a depth, or it is out of reach
  size,     // of another width than the finger of the scene, or than the one that is followed
  shape,    // not the form of a finger: too short, too long, no hand behind it, at its sides the same surface
  hand,     // as near to the palm as a thumb, or not on one line with it
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
  double width = kUnset, length = kUnset;       // of the finger, the latter at least
  double cap_slope = kUnset;                    // against the image: tangent, as the match of the cap says
  double slope = kUnset;                        // likewise, as the finger behind it says; NaN: not known
  double hand_slope = kUnset;                   // likewise, of the way from the tip to the palm
  FormEnd end = FormEnd::nothing;
  int flanks = 0;             // of four places of the finger: sides where something is as near as it
  double depth_off = kUnset;  // by which the finger behind says that its tip is farther
  Point<'C'> tip, palm;
  double hand = kUnset;  // from the tip to the palm, at least
};

struct FingerLimits {
  double nearest = 0.25, farthest = 1.5;  // m
  double radius = 0.008;                  // m, of the finger that is looked for
};

// The finger alone, before anything is known of its hand.
[[nodiscard]] Doubt doubt_of_finger(const FingerEvidence& evidence, const FingerLimits& limits);
// All of it: what a find needs that no frame before foresaw.
[[nodiscard]] Doubt doubt_of(const FingerEvidence& evidence, const FingerLimits& limits);
// The same where a followed finger is foreseen, whose cap was `cap` wide: it need not show its hand.
[[nodiscard]] Doubt doubt_of_followed(const FingerEvidence& evidence, const FingerLimits& limits, double cap);
// Widths from the tip to the palm: of several finds that are believed the farthest is the finger.
[[nodiscard]] double reach_of(const FingerEvidence& evidence);

}  // namespace enc
