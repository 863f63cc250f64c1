// The outline of a ball. What touches the ball of all rays from the camera's centre is a circular cone, and
// its axis goes through the ball's centre: m . ray = 1 for each of its unit rays, with m along the axis and
// |m| = 1 / cos(half its angle). So the centre is found as it is, not that of the ellipse that the image has,
// which lies farther out.
#pragma once

#include <array>
#include <cstddef>

#include "core/vision/ball/blob.h"
#include "core/vision/stereo/rectify.h"

namespace enc {

// So many directions from the middle of the spot in which the edge is sought.
inline constexpr std::size_t kBallRays = 72;

// Places of the edge in the raw image; NaN where a direction has none.
using BallEdges = std::array<Pixel, kBallRays>;
[[nodiscard]] BallEdges ball_edges(const ImageView& image, const Blob& blob);

struct BallOutline {
  Pixel centre;            // where the rectified image has the ball's centre
  double sine = kUnset;    // of half the cone's angle: radius over distance
  double radius = kUnset;  // px: about that of the outline
  double share = 0.0;      // of all directions: whose edges are on it
  double misfit = kUnset;  // px rms, of these
};
// The outline that most of the edges are on; the rest may be covered by something. NaN where there is none.
[[nodiscard]] BallOutline ball_outline(const BallEdges& edges, const Rectifier& rectifier, Side side);

}  // namespace enc
