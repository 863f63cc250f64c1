// A virtual object as triangles, and its picture: shaded, half transparent, by depth.
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
    float shade = 1.0F;  // of the object's colour, before the light
  };
  std::vector<Triangle> triangles;
};
// Of a plane a square of kPatch about its origin, chequered; a sphere, a mesh and a button as they are.
inline constexpr double kPatch = 0.120;  // m, side
[[nodiscard]] Facets facets_of(const Surface& surface);

// What of all objects is seen in each pixel, before hand and room.
struct Seen {
  int width = 0, height = 0;
  std::vector<float> depth;  // m, along the view; infinite where there is none
  std::vector<float> shade;  // 0 to 1
  Seen(int w, int h);
  void clear();
};
// A triangle that is not wholly in front of the camera is left out.
void draw(const Facets& facets, const RectifiedPair& pair, const Pose<'C', 'O'>& X_CO, Seen& seen);

}  // namespace enc::augment
