// Two raw images as a pair that cameras without distortion would have taken which look the same way, side by
// side: what is in a row of the one is in the same row of the other [Bouguet; Hartley and Zisserman 11.12].
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/vision/stereo/lens.h"

namespace enc {

enum class Side : std::uint8_t { left, right };

// What the rectified pair is. Its left camera stands where C does and may be turned.
struct RectifiedPair {
  double focal = kUnset;                        // px
  double centre_x = kUnset, centre_y = kUnset;  // px, of both images
  double baseline = kUnset;                     // m
  Mat3 turn = Mat3::Identity();                 // its axes in C
};

class Rectifier {
 public:
  // Throws Error where the rig is no pair: a size or focal length that is not positive, a right camera that
  // does not stand to the right, cameras that look apart by more than 30 degrees, a lens that folds.
  explicit Rectifier(const StereoRig& rig);

  [[nodiscard]] const RectifiedPair& pair() const { return pair_; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  // Raw images are rectified as they are: nothing is computed.
  [[nodiscard]] bool none_needed() const { return map_[0].empty(); }

  // Part of the rectified image; black where the raw image does not reach. Other pixels keep what they have.
  // Bilinear, by a map of 1/256 px. `raw` has the rig's size.
  void part(Side side, const ImageView& raw, const Region& wanted, Image& rectified) const;
  // Where a pixel of the raw image comes to lie.
  [[nodiscard]] Pixel rectified(Side side, const Pixel& raw) const;
  // And where one of the rectified image comes from.
  [[nodiscard]] Pixel raw(Side side, const Pixel& rectified) const;

 private:
  struct From {
    std::int16_t x = -1, y = -1;       // upper left of the four pixels; -1: outside
    std::uint8_t right = 0, down = 0;  // share of the others, 1/256
  };
  void choose_centre();
  void make_map();

  int width_ = 0, height_ = 0;
  std::array<Lens, 2> lens_;
  std::array<Mat3, 2> turn_;  // of the rectified axes in the camera's
  RectifiedPair pair_;
  std::array<std::vector<From>, 2> map_;
};

}  // namespace enc
