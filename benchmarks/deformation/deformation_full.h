// What `bench deformation --full` adds: the reference computed anew, its convergence, how much it depends on
// the ball, and the search that calibrated the seen ball.
#pragma once

#include <optional>

#include "benchmarks/deformation/fig11_contour.h"
#include "benchmarks/kit/bench.h"
#include "core/shape/surface/surface.h"

namespace enc::bench::deformation {

// Contour of the seen ball under a spherical tip from above. `sinking`: in place of the core's constants, the
// depth at which half of it is the ball's own and the radius of the dent, both over the ball's radius.
struct Sinking {
  double stiff, wide;
};
[[nodiscard]] Contour seen_contour(const Surface& ball, double tip_radius, double depth,
                                   const std::optional<Sinking>& sinking = {});

// Presses the ball with the file's elements, compares with the file and leaves a table to write it from.
[[nodiscard]] Fig11Contours add_anew(BenchResult& result, const std::string& models);

void add_full(BenchResult& result, const BenchContext& context, const Surface& ball,
              const Fig11Contours& reference);

}  // namespace enc::bench::deformation
