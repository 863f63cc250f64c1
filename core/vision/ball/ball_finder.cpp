#include "core/vision/ball/ball_finder.h"

#include <cmath>

#include "core/vision/rig/vision_check.h"

namespace enc {
namespace {

constexpr int kFewest = 80;        // pixels: a radius of 5
constexpr double kOther = 0.2;     // of the largest spot's pixels: what has more is another ball
constexpr int kMargin = 4;         // px, from the image's edge
constexpr double kClipped = 0.05;  // share of pixels
constexpr double kRound = 0.6;     // share of directions whose edges are on the outline
constexpr double kMisfit = 0.35;   // px rms
constexpr double kRows = 1.5;      // px between both images
constexpr double kSize = 0.2;      // of the distance by which size and disparity may differ

}  // namespace

BallFinder::BallFinder(const StereoRig& rig, const BallSpec& spec)
    : spec_(spec), rectifier_(rig), blobs_(spec) {
  check(spec);
}

BallFinder::~BallFinder() = default;

BallLoss BallFinder::look(Side side, const ImageView& image, FoundBall& found) {
  const auto s = static_cast<std::size_t>(side);
  const Blob blob = blobs_.largest(image);
  if (blob.pixels < kFewest) return BallLoss::no_ball;
  if (blob.second > kOther * blob.pixels) return BallLoss::two_balls;
  if (blob.box.x0 < kMargin || blob.box.y0 < kMargin || blob.box.x1 > image.width - kMargin ||
      blob.box.y1 > image.height - kMargin)
    return BallLoss::at_the_edge;
  if (blob.clipped > kClipped) return BallLoss::too_bright;
  found.edges[s] = ball_edges(image, blob);
  found.outline[s] = ball_outline(found.edges[s], rectifier_, side);
  const BallOutline& outline = found.outline[s];
  return outline.share >= kRound && outline.misfit <= kMisfit ? BallLoss::none : BallLoss::no_circle;
}

FoundBall BallFinder::find(const StereoFrame& frame) {
  FoundBall found;
  for (const ImageView* image : {&frame.left, &frame.right})
    if (image->width != rectifier_.width() || image->height != rectifier_.height()) return found;
  found.loss = look(Side::left, frame.left, found);
  if (found.loss == BallLoss::none) found.loss = look(Side::right, frame.right, found);
  if (found.loss == BallLoss::none) place(found);
  return found;
}

// Centre by centre; how large it looks says whether that can be.
void BallFinder::place(FoundBall& found) const {
  const auto& [left, right] = found.outline;
  if (!(std::abs(left.centre.row - right.centre.row) <= kRows)) {
    found.loss = BallLoss::rows;
    return;
  }
  found.at = {left.centre.column, 0.5 * (left.centre.row + right.centre.row),
              left.centre.column - right.centre.column};
  found.centre = triangulate(rectifier_.pair(), found.at);
  const double by_size = 2.0 * spec_.radius / (left.sine + right.sine);
  if (!(std::abs(by_size / found.centre.e().norm() - 1.0) <= kSize)) found.loss = BallLoss::size;
}

}  // namespace enc
