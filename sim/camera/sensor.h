// Lens and sensor of one camera of a stage: the distortion of its drawing and the noise of its pixels.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/frames.h"
#include "core/base/image.h"
#include "core/spec/optics_rig.h"

namespace enc::sim {

// The distortion of a lens on the plane z = 1: the new position of a pinhole's point (x, y), and the inverse.
// The inverse is NaN if no point is moved there.
[[nodiscard]] std::array<double, 2> distorted(const Lens& lens, double x, double y);
[[nodiscard]] std::array<double, 2> undistorted(const Lens& lens, double x, double y);
// Projection of a point in front of the camera, in its own frame: px.
[[nodiscard]] std::array<double, 2> projected(const Lens& lens, const Vec3& point);

// Drawing of one camera of a stage: an off-axis frustum with its exact intrinsics. If its lens distorts the
// picture, a somewhat larger drawing is made and distorted afterwards.
class Warp {
 public:
  // Throws Error if the lens bends so far that a pixel has no direction, or if the drawing would be more than
  // three times as wide or high.
  Warp(const Lens& lens, int width, int height);

  [[nodiscard]] bool bends() const { return bends_; }
  // The drawing: its size, and its edges on the plane z = 1, y down.
  [[nodiscard]] int width() const { return drawn_width_; }
  [[nodiscard]] int height() const { return drawn_height_; }
  [[nodiscard]] double left() const { return left_; }
  [[nodiscard]] double right() const { return right_; }
  [[nodiscard]] double top() const { return top_; }
  [[nodiscard]] double bottom() const { return bottom_; }

  // Computes the picture from the drawing, whose first row is the lowest, as in OpenGL.
  void colours(const std::uint8_t* drawing, Image& picture) const;
  // As colours(), with the nearest pixel of the drawing.
  [[nodiscard]] std::size_t nearest(int x, int y) const;

 private:
  struct Tap {  // upper left of four neighbours in the drawing, and shares of the right and lower ones
    std::uint32_t at;
    std::uint8_t right, lower;  // out of 256
  };
  void find_taps(const Lens& lens);

  int width_, height_, drawn_width_, drawn_height_;
  double left_ = 0, right_ = 0, top_ = 0, bottom_ = 0;
  bool bends_ = false;
  std::vector<Tap> taps_;
};

// Noise of an image sensor, from a table.
class SensorNoise {
 public:
  // rms in units of 255. The table holds integers with this rms; a value of 0 adds no noise. Throws Error
  // unless the value is 0 to 30.
  SensorNoise(double rms, std::uint64_t seed);
  // Gives equal bits for equal seed, frame and eye.
  void add(Image& image, std::uint64_t frame, std::uint64_t eye) const;

 private:
  std::uint64_t seed_;
  std::vector<std::int8_t> table_;
};

}  // namespace enc::sim
