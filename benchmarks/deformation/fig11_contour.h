// The committed reference for Fig 11: contours of the pressed ball of the twin (set S-nominal) under the
// rig's probe and under a stylus. A finite-element solution, kept as data (docs/notes/deformation.md).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "benchmarks/deformation/contour.h"

namespace enc::bench::deformation {

inline constexpr double kStylus = 2e-3;                   // m, tip radius
[[nodiscard]] const std::vector<double>& fig11_depths();  // m

struct Fig11Contours {
  std::vector<Contour> probe, stylus;  // for each depth
};
// From benchmarks/reference/fig11_contour.csv. Throws enc::Error, one line, where that is not as written.
[[nodiscard]] Fig11Contours load_fig11(const std::string& models);
[[nodiscard]] Fig11Contours parse_fig11(std::string_view text, const std::string& name);

}  // namespace enc::bench::deformation
