#include "core/vision/ball/ball_finder.h"

#include <cmath>

#include "core/spec/vision_check.h"

namespace enc {
namespace {

constexpr int kFewest = 80;        // pixels: a radius of 5
constexpr double kOther = 0.2;     // share of the largest spot's pixels: a spot with more is another ball
constexpr int kMargin = 4;         // px to the image's edge
constexpr double kClipped = 0.05;  // share of pixels
constexpr double kRound = 0.6;     // share of directions with an edge on the outline
constexpr double kMisfit = 0.35;   // px rms
constexpr double kRows = 1.5;      // px between the rows of both images
constexpr double kSize = 0.2;      // difference between distance by size and by disparity, as a share

}  // namespace

BallFinder::BallFinder(const StereoRig& rig, const BallSpec& spec)
    : spec_(spec), rectifier_(rig), blobs_(spec) {
  check(spec);
}

BallFinder::~BallFinder() = default;

void BallFinder::look(Side side, const ImageView& image, Rounds& rounds) {
  rounds.count = 0;
  rounds.loss = BallLoss::no_ball;
  const Blobs blobs = blobs_.largest(image, kFewest);
  for (std::size_t i = 0; i < blobs.count; ++i) {
    const Blob& blob = blobs.blob[i];
    BallLoss loss = BallLoss::no_circle;
    if (blob.box.x0 < kMargin || blob.box.y0 < kMargin || blob.box.x1 > image.width - kMargin ||
        blob.box.y1 > image.height - kMargin) {
      loss = BallLoss::at_the_edge;
    } else if (blob.clipped > kClipped) {
      loss = BallLoss::too_bright;
    } else {
      Round& round = rounds.round[rounds.count];
      round.edges = ball_edges(image, blob);
      round.outline = ball_outline(round.edges, rectifier_, side);
      if (round.outline.share >= kRound && round.outline.misfit <= kMisfit) ++rounds.count;
    }
    if (i == 0) rounds.loss = loss;
  }
}

FoundBall BallFinder::find(const StereoFrame& frame) {
  FoundBall found;
  for (const ImageView* image : {&frame.left, &frame.right})
    if (image->width != rectifier_.width() || image->height != rectifier_.height()) return found;
  auto& [left, right] = rounds_;
  look(Side::left, frame.left, left);
  look(Side::right, frame.right, right);
  if (left.count == 0 || right.count == 0) {
    found.loss = left.count == 0 ? left.loss : right.loss;
    return found;
  }
  found = placed(left.round[0], right.round[0]);
  for (std::size_t i = 0; i < left.count; ++i)
    for (std::size_t j = i == 0 ? 1 : 0; j < right.count; ++j) {
      const FoundBall other = placed(left.round[i], right.round[j]);
      if (!other.found()) continue;
      if (found.found()) {
        found = {};
        found.loss = BallLoss::two_balls;
        return found;
      }
      found = other;
    }
  return found;
}

// Triangulates the centres; the apparent size must match that distance.
FoundBall BallFinder::placed(const Round& left, const Round& right) const {
  FoundBall found;
  const Pixel &l = left.outline.centre, &r = right.outline.centre;
  found.outline = {left.outline, right.outline};
  found.edges = {left.edges, right.edges};
  found.at = {l.column, 0.5 * (l.row + r.row), l.column - r.column};
  found.centre = triangulate(rectifier_.pair(), found.at);
  const double by_size = 2.0 * spec_.radius / (left.outline.sine + right.outline.sine);
  found.loss = !(std::abs(l.row - r.row) <= kRows)                             ? BallLoss::rows
               : !(std::abs(by_size / found.centre.e().norm() - 1.0) <= kSize) ? BallLoss::size
                                                                               : BallLoss::none;
  return found;
}

}  // namespace enc
