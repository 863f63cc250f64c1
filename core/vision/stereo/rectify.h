// The geometry of the stereo head: lenses, rectification, and points by their disparity.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/spec/optics_rig.h"

namespace enc {

struct Pixel {
  double column = kUnset, row = kUnset;  // px
};

// A ray from the camera's centre, given by its intersection with the plane z = 1 of the camera's frame.
struct Ray {
  double x = kUnset, y = kUnset;
};

// A lens: from a ray to its pixel, and back. OpenCV's convention: k1, k2, p1, p2, k3 [calib3d, "Detailed
// Description"].
[[nodiscard]] Pixel project(const Lens& lens, const Ray& ray);
// NaN if no ray meets that pixel: far outside of the image, a strong distortion folds back.
[[nodiscard]] Ray ray_of(const Lens& lens, const Pixel& pixel);

enum class Side : std::uint8_t { left, right };

// Geometry of the rectified pair. Its left camera has the origin of C and may be rotated.
struct RectifiedPair {
  double focal = kUnset;                        // px
  double centre_x = kUnset, centre_y = kUnset;  // px, both images
  double baseline = kUnset;                     // m
  Mat3 turn = Mat3::Identity();                 // axes of the rectified cameras, in C
};

// Rectifies two raw images: the result is the pair of two parallel, side-by-side cameras without distortion,
// in which a point has the same row in both images [Bouguet; Hartley and Zisserman 11.12].
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
  struct SourcePixel {
    std::int16_t x = -1, y = -1;       // upper left of the four pixels; -1: outside
    std::uint8_t right = 0, down = 0;  // share of the other pixels, 1/256
  };
  void choose_centre();
  void make_map();

  int width_ = 0, height_ = 0;
  std::array<Lens, 2> lens_;
  std::array<Mat3, 2> turn_;  // rotation from the rectified axes to the camera's
  RectifiedPair pair_;
  std::array<std::vector<SourcePixel>, 2> map_;
};

// A position or a rate in (column, row, disparity), px or px/s. Matching noise is uniform in these
// coordinates.
struct Triplet {
  double column = kUnset, row = kUnset, disparity = kUnset;
  [[nodiscard]] Vec3 e() const { return {column, row, disparity}; }
};

// Converts a position in the rectified left image and a disparity to a point in C, with its uncertainty. NaN
// if the disparity is not positive.
[[nodiscard]] Point<'C'> triangulate(const RectifiedPair& pair, const Triplet& at);
// NaN if the point is not in front of the camera.
[[nodiscard]] Triplet seen_at(const RectifiedPair& pair, const Point<'C'>& point);
// Derivative of the point with respect to (column, row, disparity), m/px. Along the view it is -Z^2 / (f B)
// for the disparity.
[[nodiscard]] Mat3 slope_of(const RectifiedPair& pair, const Triplet& at);

}  // namespace enc
