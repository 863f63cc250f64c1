// What has the colour of a ball in an image, as connected spots.
#pragma once

#include <vector>

#include "core/frames.h"
#include "core/vision/ball/ball_spec.h"
#include "core/vision/image.h"

namespace enc {

struct Blob {
  int pixels = 0, second = 0;            // of the largest spot, and of the next one
  double column = kUnset, row = kUnset;  // px, its middle
  Region box;
  Vec3 colour{0, 0, 0};  // mean, 0 to 255
  double clipped = 0.0;  // share of its pixels of which a channel is at its end
};

// Keeps its memory from image to image.
class BlobFinder {
 public:
  explicit BlobFinder(const BallSpec& spec);
  // The largest spot; no pixels where there is none. mask() is of all spots.
  Blob largest(const ImageView& image);
  [[nodiscard]] const Mask& mask() const { return mask_; }

 private:
  void colour(const ImageView& image);
  Blob flood(const ImageView& image, int at);

  int hue_, within_, saturation_;  // of kHues; of 256
  Mask mask_;                      // 255: of the colour; 1: of a spot that was counted
  std::vector<int> waiting_;
};

}  // namespace enc
