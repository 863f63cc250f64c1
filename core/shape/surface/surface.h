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

// Box whose face is at z = 0 of O: a button of [VisHap 2.2], a key, a tile. It is pressed on its face alone:
// from inside, that is what is nearest, however deep; never a side.
struct Button {
  double width = kUnset, height = kUnset;  // of the face, along x and y of O, m
  double thickness = 0.050;                // of the solid behind it, m
};
// What of a button is nearest: Nearest::feature.
inline constexpr std::int32_t kButtonFace = 0, kButtonSide = 1;

class MeshTree;
// Closed triangle mesh; the tree (core/shape/surface/mesh_tree.h) is shared and constant.
struct MeshSurface {
  std::shared_ptr<const MeshTree> tree;
};

// A ball that holds the whole object. Signed distance to the object >= |p - centre| - radius, inside as well.
struct Ball {
  Point<'O'> centre;
  double radius = kUnset;  // m; infinite for a half space
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
  using Shape = std::variant<Plane, Sphere, MeshSurface, Button>;
  explicit Surface(Shape shape) : shape_(std::move(shape)) {}

  [[nodiscard]] const Shape& shape() const { return shape_; }
  [[nodiscard]] Ball bound() const noexcept;
  // Nearest surface point to p. Where several are equally near the choice is fixed: +z at the centre of a
  // sphere, the triangle of lowest index on a mesh. `hint`: the feature of a nearby query; it makes the
  // search faster and changes nothing else.
  [[nodiscard]] Nearest nearest(const Point<'O'>& p, std::int32_t hint = -1) const noexcept;
  // The point over the face that is nearest to p, if it is no farther than `margin`; else p. Of a button; of
  // what has no face of its own p itself.
  [[nodiscard]] Point<'O'> over_face(const Point<'O'>& p, double margin) const noexcept;

 private:
  Shape shape_;
};

}  // namespace enc
