#include "core/vision/hand/certainty.h"

#include <algorithm>
#include <cmath>

namespace enc {
namespace {

constexpr double kThinnest = 0.008, kThickest = 0.025;  // m, of fingertips
constexpr double kVaguest = 0.007;                      // m rms: three times as much is 20 mm
constexpr double kLongest = 0.115;                      // m
constexpr double kThin = 7.5;                           // widths: a rod is longer
constexpr double kMostAslant = 0.95;                    // tangent: beyond it little is seen of a finger
constexpr double kBent = 0.6;        // tangent: as much may the hand slope otherwise than its finger
constexpr double kFarHand = 0.158;   // m, from the fingertip to the palm of a large hand
constexpr double kPalmBehind = 0.9;  // of the finger's length
constexpr int kFlanked = 3;          // of eight sides
constexpr double kDepthOff = 0.015;  // m

// docs/notes/fingertip.md: of fingers that point all but a few have 8.4 or more, of thumbs none.
constexpr double kTrusted = 8.35;
// A finger that comes out of the image's border, without its hand.
constexpr double kBorderLength = 2.2;  // widths
constexpr double kBorderWidth = 1.12;  // times the width of the finger that is looked for

double width_of(const FingerEvidence& e) { return std::max(e.width, e.cap); }

Doubt common_doubt(const FingerEvidence& e, const FingerLimits& limits) {
  if (!e.outlined) return Doubt::outline;
  if (!(e.matched && e.depth >= limits.nearest && e.depth <= limits.farthest && e.depth_noise < kVaguest))
    return Doubt::depth;
  if (std::abs(e.depth_off) > kDepthOff) return Doubt::depth;
  if (!(e.cap >= kThinnest && e.cap <= kThickest)) return Doubt::size;
  return Doubt::no;
}

}  // namespace

double trust_of(const FingerEvidence& e, const FingerLimits& limits) {
  constexpr double kEnoughLength = 5.0, kEnoughHand = 7.0;  // widths
  constexpr double kWider = 1.06, kPrice = 4.0;             // of the finger's width; of each width more
  constexpr double kAslant = 0.3;                           // tangent: from here on each more costs as much
  return std::min(e.length / width_of(e), kEnoughLength) + std::min(e.hand / width_of(e), kEnoughHand) -
         kPrice * std::max(0.0, e.cap / (2.0 * limits.radius) - kWider) -
         std::max(0.0, std::abs(e.slope) - kAslant);
}

Doubt doubt_of(const FingerEvidence& e, const FingerLimits& limits) {
  if (const Doubt doubt = common_doubt(e, limits); doubt != Doubt::no) return doubt;
  const double lengths = e.length / width_of(e);
  if (!(lengths < kThin && e.length < kLongest && std::abs(e.slope) < kMostAslant)) return Doubt::shape;
  if (e.end == FormEnd::nothing || e.flanks >= kFlanked) return Doubt::shape;
  if (e.end == FormEnd::border && lengths > kBorderLength && e.cap < kBorderWidth * 2.0 * limits.radius)
    return Doubt::no;
  // The palm is behind the finger, not beside it; what is thick and farther off is a forearm.
  if (e.hand < kPalmBehind * e.length || e.hand > kFarHand) return Doubt::shape;
  if (std::abs(e.hand_slope - e.slope) > kBent) return Doubt::hand;
  return trust_of(e, limits) >= kTrusted ? Doubt::no : Doubt::hand;
}

Doubt doubt_of_followed(const FingerEvidence& e, const FingerLimits& limits, double cap) {
  constexpr double kAlike = 1.2;     // times as wide
  constexpr double kShortest = 1.2;  // widths
  if (const Doubt doubt = common_doubt(e, limits); doubt != Doubt::no) return doubt;
  if (!(e.cap < kAlike * cap && cap < kAlike * e.cap)) return Doubt::size;
  return e.length / width_of(e) > kShortest && e.flanks < kFlanked ? Doubt::no : Doubt::shape;
}

}  // namespace enc
