// Finds the centre of a coloured ball in one pair of raw images, for the registration of camera and arm. It
// ignores earlier frames, and prefers no result to a wrong one. A spot of the ball's colour must be round in
// both images, in one row, and as large as its distance requires. There must be no other such spot.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/words.h"
#include "core/devices/device.h"
#include "core/vision/ball/outline.h"
#include "core/vision/stereo/rectify.h"

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

// Virtual, because the registration gets it from the module `vision`.
class BallFinder {
 public:
  // Throws Error if the numbers are impossible.
  BallFinder(const StereoRig& rig, const BallSpec& spec);
  virtual ~BallFinder();
  BallFinder(const BallFinder&) = delete;
  BallFinder& operator=(const BallFinder&) = delete;

  // Finds no ball in a frame of another size than the rig's.
  virtual FoundBall find(const StereoFrame& frame);

 private:
  // A round spot in an image.
  struct Round {
    BallOutline outline;
    BallEdges edges;
  };
  struct Rounds {
    std::array<Round, kMostBlobs> round;
    std::size_t count = 0;
    BallLoss loss = BallLoss::no_ball;  // reason of the largest spot, if no spot is round
  };
  void look(Side side, const ImageView& image, Rounds& rounds);
  [[nodiscard]] FoundBall placed(const Round& left, const Round& right) const;

  BallSpec spec_;
  Rectifier rectifier_;
  BlobFinder blobs_;
  std::array<Rounds, 2> rounds_;
};

}  // namespace enc
