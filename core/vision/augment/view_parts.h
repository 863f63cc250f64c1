// The parts of the augmented view: the background behind the arm, the pixels of the arm, and the objects.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/machine/arm_shape.h"
#include "core/shape/surface/surface.h"
#include "core/vision/stereo/rectify.h"

namespace enc::augment {

// The background without the objects in front of it, completed over time: each pixel is learned from frames
// that show it uncovered, whenever they come.
class CleanBackground {
 public:
  // `frames`: number of frames averaged for a pixel, as many as for the tracker's background.
  CleanBackground(int width, int height, int frames);

  // Adds a frame; `covered` marks pixels that may not be background. A pixel is learned from that number of
  // uncovered frames that agree with each other, so moving things do not get in. Once learned, a pixel stays.
  void add(const ImageView& frame, const Mask& covered);
  [[nodiscard]] const Mask& known() const { return known_; }
  [[nodiscard]] bool any() const { return any_; }  // true if any pixel is known
  // The background; pixels that were never uncovered are continued from their surroundings.
  [[nodiscard]] const Image& image();

  // Out of 255, each channel: eight times a sensor's noise of 1.5.
  static constexpr int kAlike = 12;

 private:
  void fill();

  int frames_;
  bool any_ = false;
  bool stale_ = true;  // learned more since the last fill
  Mask known_;
  Image image_;
  std::vector<std::uint16_t> sum_;
  std::vector<std::uint8_t> count_;
};

// A virtual object as triangles, and its picture: shaded, half transparent, with depth.
struct Facets {
  std::vector<Point<'O'>> corners;
  struct Triangle {
    std::array<std::int32_t, 3> corner{};
    float shade = 1.0F;  // factor on the object's colour, before the light
  };
  std::vector<Triangle> triangles;
};
// Triangles of a surface. A plane becomes a chequered square of kPatch about its origin; a sphere, a mesh and
// a button keep their shape.
inline constexpr double kPatch = 0.120;  // m, side
[[nodiscard]] Facets facets_of(const Surface& surface);

// The visible surface of all objects in each pixel, without hand and room.
struct DepthPicture {
  int width = 0, height = 0;
  std::vector<float> depth;  // m, along the view; infinite: no object
  std::vector<float> shade;  // 0 to 1
  DepthPicture(int w, int h);
  void clear();
};
// Skips a triangle that is not wholly in front of the camera.
void draw(const Facets& facets, const RectifiedPair& pair, const Pose<'C', 'O'>& X_CO, DepthPicture& seen);

// Pixels of an arm's part in the rectified left image, by the part's modelled position. Sets the pixels of
// the part, and those within `margin` px of it. Only the portion of the part in front of the camera counts.
void cover(const RectifiedPair& pair, const Pose<'C', 'W'>& X_CW, const ArmPart& part, double margin,
           Mask& mask);

}  // namespace enc::augment
