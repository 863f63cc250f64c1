#include "models/sizes/mesh_size.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace enc::models {
namespace {

struct LengthUnit {
  double in_metres;
  const char* label;
};
constexpr auto kLengths =
    std::to_array<LengthUnit>({{1e-9, "nm"}, {1e-6, "um"}, {1e-3, "mm"}, {1.0, "m"}, {1e3, "km"}});

// The unit that gives at most three digits before the point; mm for zero.
LengthUnit unit_for(double metres) {
  const double size = std::abs(metres) * 1.0005;  // 999.6 is printed as 1000
  if (size == 0.0) return kLengths[2];
  const auto larger =
      std::find_if(kLengths.begin(), kLengths.end(), [&](const LengthUnit& u) { return u.in_metres > size; });
  return larger == kLengths.begin() ? *larger : *(larger - 1);
}
// Three digits; a value below a thousandth of the largest is 0.
std::string in_unit(double metres, double largest, const LengthUnit& unit) {
  return std::abs(metres) < 5e-4 * largest ? "0" : fmt::format("{:.3g}", metres / unit.in_metres);
}
std::string three(const Vec3& v, const char* between) {
  const double largest = v.cwiseAbs().maxCoeff();
  const LengthUnit unit = unit_for(largest);
  return fmt::format("{}{}{}{}{}", in_unit(v.x(), largest, unit), between, in_unit(v.y(), largest, unit),
                     between, in_unit(v.z(), largest, unit));
}

}  // namespace

MeshSize size_of(const Mesh& mesh) {
  MeshSize size;
  size.faces = mesh.triangles.size();
  if (mesh.vertices.empty()) return size;
  const auto at = [&](std::int32_t i) { return Vec3(mesh.vertices[static_cast<std::size_t>(i)].data()); };
  const MeshBox box(mesh);
  size.extent = box.extent();
  size.middle = 0.5 * (box.low + box.high);
  for (const auto& t : mesh.triangles) {
    const Vec3 a = at(t[0]) - size.middle, b = at(t[1]) - size.middle, c = at(t[2]) - size.middle;
    size.volume += a.dot(b.cross(c)) / 6.0;
  }
  return size;
}

std::string length_text(double metres) {
  if (std::abs(metres) < 1e-12) return "0 mm";  // rounding error at a size of a metre
  const LengthUnit unit = unit_for(metres);
  return fmt::format("{:.3g} {}", metres / unit.in_metres, unit.label);
}

std::string extent_text(const Vec3& extent) {
  return fmt::format("{} {}", three(extent, " x "), unit_for(extent.maxCoeff()).label);
}

std::string place_text(const Vec3& place) {
  return fmt::format("({}) {}", three(place, ", "), unit_for(place.cwiseAbs().maxCoeff()).label);
}

std::string volume_text(double cubic_metres) {
  struct VolumeUnit {
    double in_cubic_metres;
    const char* label;
  };
  constexpr VolumeUnit kSmall{1e-9, "mm^3"}, kHandy{1e-6, "cm^3"}, kLarge{1.0, "m^3"};
  const VolumeUnit unit = cubic_metres < 1e-6 ? kSmall : cubic_metres < 1.0 ? kHandy : kLarge;
  return fmt::format("{:.3g} {}", cubic_metres / unit.in_cubic_metres, unit.label);
}

}  // namespace enc::models
