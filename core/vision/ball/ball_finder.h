// Where the centre of a coloured ball is, out of one pair of raw images: for the registration of camera and
// arm. It knows nothing of the frame before, and rather finds nothing than something else: a spot of the
// ball's colour is round in both images, in the same row, and as large as its distance makes it; and no
// other.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/words.h"
#include "core/devices/stereo_camera.h"
#include "core/vision/ball/blob.h"
#include "core/vision/ball/outline.h"
#include "core/vision/stereo/triangulate.h"

namespace enc {

enum class BallLoss : std::uint8_t {
  none,
  no_ball,
  two_balls,
  at_the_edge,
  too_bright,
  no_circle,
  rows,
  size,
  no_frame
};
constexpr auto words(BallLoss) {
  return enum_words("found", "nothing of its colour", "more than one", "cut off by the edge of the image",
                    "too bright to have a colour", "not round", "not in the same row of both images",
                    "not of its size", "no frame");
}

struct FoundBall {
  BallLoss loss = BallLoss::no_ball;
  Point<'C'> centre;
  Triplet at;
  std::array<BallOutline, 2> outline;  // left and right
  std::array<BallEdges, 2> edges;      // px, in the raw images
  [[nodiscard]] bool found() const { return loss == BallLoss::none; }
};

// Virtual, because whoever registers has it from the module `vision`.
class BallFinder {
 public:
  // Throws Error where the numbers are impossible.
  BallFinder(const StereoRig& rig, const BallSpec& spec);
  virtual ~BallFinder();
  BallFinder(const BallFinder&) = delete;
  BallFinder& operator=(const BallFinder&) = delete;

  // A frame of another size than the rig's has no ball.
  virtual FoundBall find(const StereoFrame& frame);

 private:
  // What is round in an image.
  struct Round {
    BallOutline outline;
    BallEdges edges;
  };
  struct Rounds {
    std::array<Round, kMostBlobs> round;
    std::size_t count = 0;
    BallLoss loss = BallLoss::no_ball;  // of the largest spot, where nothing is round
  };
  void look(Side side, const ImageView& image, Rounds& rounds);
  [[nodiscard]] FoundBall placed(const Round& left, const Round& right) const;

  BallSpec spec_;
  Rectifier rectifier_;
  BlobFinder blobs_;
  std::array<Rounds, 2> rounds_;
};

}  // namespace enc
