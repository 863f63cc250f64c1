// Size and position of a mesh, for messages: they reveal a wrong unit or origin first.
#pragma once

#include <cstddef>
#include <limits>
#include <string>

#include "core/base/frames.h"
#include "core/shape/surface/mesh.h"

namespace enc::models {

// The box around its vertices, in the mesh's own axes, m. Without a vertex, low is above high.
struct MeshBox {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  explicit MeshBox(const Mesh& mesh) {
    for (const auto& vertex : mesh.vertices) {
      low = low.cwiseMin(Vec3(vertex.data()));
      high = high.cwiseMax(Vec3(vertex.data()));
    }
  }
  [[nodiscard]] Vec3 extent() const { return high - low; }
  [[nodiscard]] double size() const { return extent().maxCoeff(); }
};

struct MeshSize {
  Vec3 extent = Vec3::Zero();  // extent of the box around it, m
  Vec3 middle = Vec3::Zero();  // middle of that box, m
  double volume = 0.0;         // m^3, for a closed outward mesh
  std::size_t faces = 0;
};
// Measures the vertices in the mesh's own axes; everything is zero without a vertex.
[[nodiscard]] MeshSize size_of(const Mesh& mesh);

// "1.25 mm": three digits, in the unit from nm to km that gives a number from 1 to 1000. "0 mm" below 1e-12
// m.
[[nodiscard]] std::string length_text(double metres);
// "67 x 67 x 60 mm": in the unit of the longest side.
[[nodiscard]] std::string extent_text(const Vec3& extent);
// "(1200, 0, 0) m"
[[nodiscard]] std::string place_text(const Vec3& place);
// "50.9 cm^3"
[[nodiscard]] std::string volume_text(double cubic_metres);

}  // namespace enc::models
