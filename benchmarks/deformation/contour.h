// How far two contours of a dented ball are apart, and how much of their dents is common: sections through
// the axis, r sideways, z upwards, origin in the ball's middle, from the pole outwards; m.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace enc::bench::deformation {

using Vec2 = Eigen::Vector2d;
using Contour = std::vector<Vec2>;

// A point counts as dented that is this far off the undeformed ball.
inline constexpr double kDented = 0.1e-3;  // m

// Over the visible half, z >= 0. Distances are those of points spaced evenly along one contour to the nearest
// point of the other, both ways.
struct ContourGap {
  double rms = 0.0, largest = 0.0;  // m, where either is dented
  double half_rms = 0.0;            // m, of the whole half
};
[[nodiscard]] ContourGap contour_gap(const Contour& a, const Contour& b, double ball_radius);

// How far b is outside of a (negative: inside), along a; x is the length along a from the pole; m.
struct GapAlong {
  std::vector<double> length, outside;
};
[[nodiscard]] GapAlong gap_along(const Contour& a, const Contour& b);

// The dent is what is inside the undeformed ball and over the contour. Its common part over what either has.
struct Overlap {
  double area = 0.0;    // of the section
  double volume = 0.0;  // of the solid of revolution
};
[[nodiscard]] Overlap overlap(const Contour& a, const Contour& b, double ball_radius);

// The committed reference for Fig 11: contours of the pressed ball of the twin (set S-nominal) under the
// rig's probe and under a stylus. A finite-element solution, kept as data (docs/notes/deformation.md).

inline constexpr double kStylus = 2e-3;                   // m, tip radius
[[nodiscard]] const std::vector<double>& fig11_depths();  // m

struct Fig11Contours {
  std::vector<Contour> probe, stylus;  // for each depth
};
// From benchmarks/reference/fig11_contour.csv. Throws enc::Error, one line, where that is not as written.
[[nodiscard]] Fig11Contours load_fig11(const std::string& models);
[[nodiscard]] Fig11Contours parse_fig11(std::string_view text, const std::string& name);

}  // namespace enc::bench::deformation
