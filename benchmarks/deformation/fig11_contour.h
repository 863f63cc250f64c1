// The committed reference for Fig 11: contours of the pressed ball of the twin (set S-nominal) under the
// rig's probe and under a stylus, as computed by press_shell().
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "benchmarks/deformation/shell_press.h"
#include "benchmarks/kit/bench.h"

namespace enc::bench::deformation {

inline constexpr double kStylus = 2e-3;                   // m, tip radius
[[nodiscard]] const std::vector<double>& fig11_depths();  // m

// Elements of the wall: through it, and how long under the probe (m).
struct Fineness {
  int through;
  double fine;
};
inline constexpr Fineness kFine{16, 0.125e-3};  // of the file
inline constexpr Fineness kCoarse{8, 0.25e-3};  // what a run compares it with

// One for each depth.
[[nodiscard]] std::vector<PressedShell> press_fig11(double tip_radius, Fineness fineness);

// How far the file may be off: what half as fine elements change, over 3 (order 2); m.
[[nodiscard]] double own_error(const std::vector<PressedShell>& coarse, const std::vector<Contour>& fine);

struct Fig11Contours {
  std::vector<Contour> probe, stylus;  // for each depth
};
// From benchmarks/reference/fig11_contour.csv. Throws enc::Error, one line, where that is not as written.
[[nodiscard]] Fig11Contours load_fig11(const std::string& models);
[[nodiscard]] Fig11Contours parse_fig11(std::string_view text, const std::string& name);

// The file: its CSV is table_csv() of this.
[[nodiscard]] Table fig11_table(const std::vector<PressedShell>& probe,
                                const std::vector<PressedShell>& stylus, double error);

}  // namespace enc::bench::deformation
