// Surfaces of objects: nearest point, outward normal, signed distance [VHMR 3.3]. The seam that meshes join.
#pragma once

#include <cstdint>
#include <variant>

#include "core/frames.h"

namespace enc {

// Half space under z = 0 of O; the outward normal is +z.
struct Plane {};
// Ball around the origin of O.
struct Sphere {
  double radius = kUnset;
};

struct Nearest {
  Point<'O'> point;          // on the surface
  Vec<'O'> normal;           // outward, unit
  double distance = kUnset;  // of the query, m; negative inside
  std::int32_t feature =
      -1;  // which part of the surface; a hint for the next query. -1: the surface has no parts
};

class Surface {
 public:
  using Shape = std::variant<Plane, Sphere>;
  explicit Surface(Shape shape) : shape_(shape) {}

  [[nodiscard]] const Shape& shape() const { return shape_; }
  // Nearest surface point to p. Where several are equally near (the centre of a sphere) the choice is fixed:
  // +z.
  [[nodiscard]] Nearest nearest(const Point<'O'>& p, std::int32_t hint = -1) const noexcept;

 private:
  Shape shape_;
};

}  // namespace enc
