// Surfaces of objects: nearest point, outward normal, signed distance [VHMR 3.3].
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <variant>

#include "core/base/frames.h"

namespace enc {

// Half space under z = 0 of O; the outward normal is +z.
struct Plane {};
// Ball around the origin of O.
struct Sphere {
  double radius = kUnset;
};

// Box whose face is at z = 0 of O: a button of [VisHap 2.2], a key, a tile. Only its face can be pressed:
// from inside, the face is always the nearest part, however deep, and never a side.
struct Button {
  // Size of the face along x and y of O, m.
  double width = kUnset, height = kUnset;
  double thickness = 0.050;  // thickness of the solid behind the face, m
};
// The nearest part of a button: Nearest::feature.
inline constexpr std::int32_t kButtonFace = 0, kButtonSide = 1;

class MeshTree;
// Closed triangle mesh; the tree (core/shape/surface/mesh_tree.h) is shared and constant.
struct MeshSurface {
  std::shared_ptr<const MeshTree> tree;
};

// A ball that contains the whole object. The signed distance to the object is at least |p - centre| - radius,
// inside too.
struct Ball {
  Point<'O'> centre;
  double radius = kUnset;  // m; infinite for a half space
};

struct SurfacePoint {
  Point<'O'> point;          // on the surface
  Vec<'O'> normal;           // outward, unit
  double distance = kUnset;  // distance of the query, m; negative inside
  // The part of the surface, a hint for the next query. -1: the surface has no parts.
  std::int32_t feature = -1;
};

class Surface {
 public:
  using Shape = std::variant<Plane, Sphere, MeshSurface, Button>;
  explicit Surface(Shape shape) : shape_(std::move(shape)) {}

  [[nodiscard]] const Shape& shape() const { return shape_; }
  [[nodiscard]] Ball bound() const noexcept;
  // Nearest surface point to p. If several are equally near, the choice is fixed: +z at the centre of a
  // sphere, the triangle of lowest index on a mesh. `hint`: the feature of a nearby query; it only makes the
  // search faster.
  [[nodiscard]] SurfacePoint nearest(const Point<'O'>& p, std::int32_t hint = -1) const noexcept;
  // Button: the nearest point over the face, if it is within `margin` of p; else p. Shapes without a face
  // return p.
  [[nodiscard]] Point<'O'> over_face(const Point<'O'>& p, double margin) const noexcept;

 private:
  Shape shape_;
};

}  // namespace enc
