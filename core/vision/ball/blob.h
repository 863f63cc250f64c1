// Connected spots of a ball's colour in an image.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/base/frames.h"
#include "core/base/image.h"
#include "core/spec/vision/ball_spec.h"

namespace enc {

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

}  // namespace enc
