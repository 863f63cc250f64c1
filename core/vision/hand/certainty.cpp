#include "core/vision/hand/certainty.h"

#include <algorithm>
#include <cmath>

namespace enc {
namespace {

// Widths of caps relative to the scene's finger, which is 16 mm unless the scene defines it. Index fingers of
// adults are 13 to 18 mm wide at the last joint, thumbs 18 to 23 mm (docs/notes/fingertip.md).
constexpr double kNarrowest = 0.55, kWidest = 1.14;
constexpr double kVaguest = 0.007;   // m rms: three times this is 20 mm
constexpr double kDepthOff = 0.015;  // m

// Lengths of a straight finger in its widths: a thumb is shorter, a rod longer.
constexpr double kShort = 3.0, kLong = 7.5;
// A cap as wide as the scene's finger, or a little narrower, is not the thumb of its hand. It may be shorter
// and nearer to its palm.
constexpr double kAlikeLeast = 0.80, kAlikeMost = 0.98, kAlikeShort = 2.3, kAlikeNearHand = 3.8;
constexpr double kLongest = 0.115;    // m
constexpr double kMostAslant = 0.85;  // tangent: at a steeper slope too little of a finger is visible
constexpr int kFlanked = 3;           // of eight sides

// A thumb ends nearer to its palm, in its widths; a thick part farther away is a forearm.
constexpr double kNearHand = 5.0;
constexpr double kFarHand = 0.158;   // m, from the fingertip to the palm of a large hand
constexpr double kPalmBehind = 0.9;  // share of the finger's length
constexpr double kBent = 0.6;        // tangent: largest difference in slope between hand and finger
// A finger that enters across the image's border shows no hand.
constexpr double kBorderLength = 2.2;  // widths

double width_of(const FingerEvidence& e) { return std::max(e.width, e.cap); }

Doubt doubt_of_cap(const FingerEvidence& e, const FingerLimits& limits) {
  if (!e.outlined) return Doubt::outline;
  if (!(e.matched && e.depth >= limits.nearest && e.depth <= limits.farthest && e.depth_noise < kVaguest))
    return Doubt::depth;
  return Doubt::no;
}

double widths_long(const FingerEvidence& e) { return e.length / width_of(e); }

double size_of(const FingerEvidence& e, const FingerLimits& limits) { return e.cap / (2.0 * limits.radius); }

bool is_no_thumb(const FingerEvidence& e, const FingerLimits& limits) {
  const double size = size_of(e, limits);
  return size >= kAlikeLeast && size <= kAlikeMost;
}

bool comes_out_of_the_border(const FingerEvidence& e) {
  return e.end == FormEnd::border && widths_long(e) > kBorderLength;
}

}  // namespace

double reach_of(const FingerEvidence& e) { return e.hand / width_of(e); }

Doubt doubt_of_finger(const FingerEvidence& e, const FingerLimits& limits) {
  if (const Doubt doubt = doubt_of_cap(e, limits); doubt != Doubt::no) return doubt;
  if (std::abs(e.depth_off) > kDepthOff) return Doubt::depth;
  const double size = size_of(e, limits);
  if (!(size >= kNarrowest && size <= kWidest)) return Doubt::size;
  if (e.end == FormEnd::nothing || e.flanks >= kFlanked) return Doubt::shape;
  if (!(widths_long(e) < kLong && e.length < kLongest)) return Doubt::shape;
  if (std::abs(e.slope) > kMostAslant) return Doubt::shape;
  if (comes_out_of_the_border(e)) return Doubt::no;
  return widths_long(e) >= (is_no_thumb(e, limits) ? kAlikeShort : kShort) ? Doubt::no : Doubt::shape;
}

Doubt doubt_of(const FingerEvidence& e, const FingerLimits& limits) {
  if (const Doubt doubt = doubt_of_finger(e, limits); doubt != Doubt::no) return doubt;
  if (comes_out_of_the_border(e)) return Doubt::no;
  if (!(e.hand >= kPalmBehind * e.length && e.hand <= kFarHand)) return Doubt::hand;
  if (is_no_thumb(e, limits)) return reach_of(e) >= kAlikeNearHand ? Doubt::no : Doubt::hand;
  if (std::abs(e.hand_slope - (std::isnan(e.slope) ? e.cap_slope : e.slope)) > kBent) return Doubt::hand;
  return reach_of(e) >= kNearHand ? Doubt::no : Doubt::hand;
}

Doubt doubt_of_followed(const FingerEvidence& e, const FingerLimits& limits, double cap) {
  constexpr double kAlike = 1.3;     // times as wide
  constexpr double kShortest = 1.2;  // widths
  if (const Doubt doubt = doubt_of_cap(e, limits); doubt != Doubt::no) return doubt;
  if (!(e.cap < kAlike * cap && cap < kAlike * e.cap)) return Doubt::size;
  return e.length / width_of(e) > kShortest ? Doubt::no : Doubt::shape;
}

}  // namespace enc
