// The tip of a hand-held tool, which touches and deforms objects. Each of the three shapes is a family of
// balls, so that the lowest point is simple to compute.
#pragma once

#include <cstdint>

#include "core/base/frames.h"
#include "core/base/words.h"

namespace enc {

enum class TipShape : std::uint8_t {
  sphere,  // one ball
  cone,    // rounded apex; the ball is the apex
  // Straight and rounded: a ball swept along a line (a chisel, a ruler).
  edge
};
constexpr auto words(TipShape) { return enum_words("sphere", "cone", "edge"); }

// The tip in frame A, without the tool above it.
template <char A>
struct Tip {
  Point<A> centre;      // centre of the ball; edge: its middle
  double radius = 0.0;  // radius of the ball, m; 0: a point
  TipShape shape = TipShape::sphere;
  // Unit vector. Cone: from the apex into the tool; edge: along the edge.
  Vec<A> axis{0.0, 0.0, 1.0};
  double half_angle = 0.0;  // cone, rad
  // Edge only: distance between the centres of its end balls, m.
  double length = 0.0;
};

template <char A, char B>
Tip<A> operator*(const Pose<A, B>& X_AB, const Tip<B>& tip) {
  return {X_AB * tip.centre, tip.radius, tip.shape, X_AB * tip.axis, tip.half_angle, tip.length};
}

}  // namespace enc
