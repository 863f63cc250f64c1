// Spots of a ball's colour, and the outline of a ball.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/base/frames.h"
#include "core/base/image.h"
#include "core/spec/vision_rig.h"
#include "core/vision/stereo/rectify.h"

namespace enc {

// Connected spots of a ball's colour in an image.
struct Blob {
  int pixels = 0;
  double column = kUnset, row = kUnset;  // px, middle of the spot
  Region box;
  Vec3 colour{0, 0, 0};  // mean, 0 to 255
  double clipped = 0.0;  // share of its pixels with a saturated channel
};
inline constexpr std::size_t kMostBlobs = 8;
struct Blobs {
  std::array<Blob, kMostBlobs> blob;
  std::size_t count = 0;
};

// Keeps its memory from image to image.
class BlobFinder {
 public:
  explicit BlobFinder(const BallSpec& spec);
  // The largest spots of at least `least` pixels, largest first.
  Blobs largest(const ImageView& image, int least);

 private:
  void colour(const ImageView& image);
  Blob flood(const ImageView& image, int at);

  int hue_, within_, saturation_;  // hues in steps of kHues; saturation out of 256
  // 255: pixel of the colour; 1: pixel of a counted spot.
  Mask mask_;
  std::vector<int> waiting_;
};

// Number of directions from the middle of the spot in which the edge is searched.
inline constexpr std::size_t kBallRays = 72;

// Edge points in the raw image; NaN in a direction without an edge.
using BallEdges = std::array<Pixel, kBallRays>;
[[nodiscard]] BallEdges ball_edges(const ImageView& image, const Blob& blob);

// The outline of a ball. The rays from the camera's centre that touch the ball form a circular cone, whose
// axis goes through the ball's centre: m . ray = 1 for each of its unit rays, with m along the axis and |m| =
// 1 / cos(half its angle). So the fit gives the centre of the ball itself, and not that of its elliptic
// image, which lies farther out.
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
