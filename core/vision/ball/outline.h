// The outline of a ball. The rays from the camera's centre that touch the ball form a circular cone, whose
// axis goes through the ball's centre: m . ray = 1 for each of its unit rays, with m along the axis and |m| =
// 1 / cos(half its angle). So the fit gives the centre of the ball itself, and not that of its elliptic
// image, which lies farther out.
#pragma once

#include <array>
#include <cstddef>

#include "core/vision/ball/blob.h"
#include "core/vision/stereo/rectify.h"

namespace enc {

// Number of directions from the middle of the spot in which the edge is searched.
inline constexpr std::size_t kBallRays = 72;

// Edge points in the raw image; NaN in a direction without an edge.
using BallEdges = std::array<Pixel, kBallRays>;
[[nodiscard]] BallEdges ball_edges(const ImageView& image, const Blob& blob);

struct BallOutline {
  Pixel centre;            // ball's centre in the rectified image
  double sine = kUnset;    // sine of half the cone's angle: radius over distance
  double radius = kUnset;  // px: approximate radius of the outline
  double share = 0.0;      // share of directions with an edge on the outline
  double misfit = kUnset;  // px rms, of those edges
};
// The outline that fits most of the edges; the rest may be occluded. NaN if there is no such outline.
[[nodiscard]] BallOutline ball_outline(const BallEdges& edges, const Rectifier& rectifier, Side side);

}  // namespace enc
