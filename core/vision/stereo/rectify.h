// Rectifies two raw images: the result is the pair of two parallel, side-by-side cameras without distortion,
// in which a point has the same row in both images [Bouguet; Hartley and Zisserman 11.12].
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/vision/stereo/lens.h"

namespace enc {

enum class Side : std::uint8_t { left, right };

// Geometry of the rectified pair. Its left camera has the origin of C and may be rotated.
struct RectifiedPair {
  double focal = kUnset;                        // px
  double centre_x = kUnset, centre_y = kUnset;  // px, both images
  double baseline = kUnset;                     // m
  Mat3 turn = Mat3::Identity();                 // axes of the rectified cameras, in C
};

class Rectifier {
 public:
  // Throws Error if the rig is not a stereo pair: a size or focal length that is not positive, a right camera
  // that is not to the right, axes more than 30 degrees apart, a lens that folds.
  explicit Rectifier(const StereoRig& rig);

  [[nodiscard]] const RectifiedPair& pair() const { return pair_; }
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  // True if raw images are already rectified; then nothing is computed.
  [[nodiscard]] bool none_needed() const { return map_[0].empty(); }

  // Rectifies a part of the image; black outside of the raw image. Other pixels stay. Bilinear, by a map of
  // 1/256 px. `raw` has the rig's size.
  void part(Side side, const ImageView& raw, const Region& wanted, Image& rectified) const;
  // Rectified position of a pixel of the raw image.
  [[nodiscard]] Pixel rectified(Side side, const Pixel& raw) const;
  // Raw position of a pixel of the rectified image.
  [[nodiscard]] Pixel raw(Side side, const Pixel& rectified) const;

 private:
  struct From {
    std::int16_t x = -1, y = -1;       // upper left of the four pixels; -1: outside
    std::uint8_t right = 0, down = 0;  // share of the other pixels, 1/256
  };
  void choose_centre();
  void make_map();

  int width_ = 0, height_ = 0;
  std::array<Lens, 2> lens_;
  std::array<Mat3, 2> turn_;  // rotation from the rectified axes to the camera's
  RectifiedPair pair_;
  std::array<std::vector<From>, 2> map_;
};

}  // namespace enc
