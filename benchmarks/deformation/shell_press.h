// The reference for the seen surface: where the felt of a ball ends that a probe presses, by Newton's method
// on the energy of shell_energy.h, the probe going down in small steps.
#pragma once

#include <vector>

#include "benchmarks/deformation/contour.h"
#include "benchmarks/deformation/shell_energy.h"

namespace enc::bench::deformation {

struct PressedShell {
  double depth = 0.0;       // m
  double force = 0.0;       // N, at rest, without the rubber's and the felt's losses
  double residual = 0.0;    // N, largest force on a node that is not balanced
  double core_depth = 0.0;  // m, of the wall's inner side at the pole
  Contour contour;          // m, outer side of the felt from the pole to the mount
};

// At each of `depths` (m, rising). Throws enc::Error where no state of rest is found.
[[nodiscard]] std::vector<PressedShell> press_shell(const sim::BallParameters& ball, int through, double fine,
                                                    const std::vector<double>& depths);

}  // namespace enc::bench::deformation
