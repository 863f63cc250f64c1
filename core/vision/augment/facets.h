// A virtual object as triangles, and its picture: shaded, half transparent, with depth.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/image.h"
#include "core/shape/surface/surface.h"
#include "core/vision/stereo/rectify.h"

namespace enc::augment {

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
struct Seen {
  int width = 0, height = 0;
  std::vector<float> depth;  // m, along the view; infinite: no object
  std::vector<float> shade;  // 0 to 1
  Seen(int w, int h);
  void clear();
};
// Skips a triangle that is not wholly in front of the camera.
void draw(const Facets& facets, const RectifiedPair& pair, const Pose<'C', 'O'>& X_CO, Seen& seen);

}  // namespace enc::augment
