// The tip of a hand-held tool: what touches and dents. Three shapes, each a family of balls, so that what is
// lowest is simple.
#pragma once

#include <cstdint>

#include "core/base/frames.h"
#include "core/base/words.h"

namespace enc {

enum class TipShape : std::uint8_t {
  sphere,  // one ball
  cone,    // with a rounded apex, which is the ball
  edge     // straight, rounded: the ball swept along it (a chisel, a ruler)
};
constexpr auto words(TipShape) { return enum_words("sphere", "cone", "edge"); }

// As seen from frame A. The tip alone: the tool above it is not part of the shape.
template <char A>
struct Tip {
  Point<A> centre;      // of the ball; of an edge: of its middle
  double radius = 0.0;  // of the ball, m; 0: a point
  TipShape shape = TipShape::sphere;
  Vec<A> axis{0.0, 0.0, 1.0};  // unit; cone: from the apex into the tool, edge: along it
  double half_angle = 0.0;     // cone, rad
  double length = 0.0;         // edge, m, between the centres of its end balls
};

template <char A, char B>
Tip<A> operator*(const Pose<A, B>& X_AB, const Tip<B>& tip) {
  return {X_AB * tip.centre, tip.radius, tip.shape, X_AB * tip.axis, tip.half_angle, tip.length};
}

}  // namespace enc
