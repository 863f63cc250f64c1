// Distance between two contours of a dented ball, and the common share of their dents. Contours are sections
// through the axis: r sideways, z upwards, origin in the ball's middle, from the pole outwards; m.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace enc::bench::deformation {

using Vec2 = Eigen::Vector2d;
using Contour = std::vector<Vec2>;

// A point counts as dented if it is this far off the undeformed ball.
inline constexpr double kDented = 0.1e-3;  // m

// Compares the visible half, z >= 0. Points spaced evenly along one contour are measured to the nearest point
// of the second, in both directions.
struct ContourGap {
  double rms = 0.0, largest = 0.0;  // m, where either is dented
  double half_rms = 0.0;            // m, of the whole half
};
[[nodiscard]] ContourGap contour_gap(const Contour& a, const Contour& b, double ball_radius);

// Distance of b outside a (negative: inside), along a; x is the length along a from the pole; m.
struct GapProfile {
  std::vector<double> length, outside;
};
[[nodiscard]] GapProfile gap_along(const Contour& a, const Contour& b);

// The dent is the region inside the undeformed ball and above the contour. Overlap: the common part over the
// union.
struct Overlap {
  double area = 0.0;    // of the section
  double volume = 0.0;  // volumes of the solids of revolution
};
[[nodiscard]] Overlap overlap(const Contour& a, const Contour& b, double ball_radius);

// The committed reference for Fig 11: contours of the pressed ball of the twin (set S-nominal) under the
// rig's probe and under a stylus. A finite-element solution, kept as data (docs/notes/deformation.md).

inline constexpr double kStylus = 2e-3;                   // m, tip radius
[[nodiscard]] const std::vector<double>& fig11_depths();  // m

struct Fig11Contours {
  std::vector<Contour> probe, stylus;  // for each depth
};
// Reads benchmarks/reference/fig11_contour.csv. Throws enc::Error, one line, if the file is malformed.
[[nodiscard]] Fig11Contours load_fig11(const std::string& models);
[[nodiscard]] Fig11Contours parse_fig11(std::string_view text, const std::string& name);

}  // namespace enc::bench::deformation
