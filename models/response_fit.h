// From a measured loop of deflection and force to the two polynomials of a response [VHMR 4.2], such that an
// admittance can render them: zero at zero, never softer than the loop is stable, press never below release.
#pragma once

#include <span>

#include "core/response.h"

namespace enc::models {

struct LoopPoint {
  double deflection = 0.0;  // m
  double force = 0.0;       // N
  bool pressing = true;     // else releasing
};

// Root mean squares of the residuals, N. "Free": least squares that is zero at zero and nothing else; the
// difference is what the constraints cost.
struct ResponseFit {
  ResponseSpec spec;
  double rmse_press = 0.0, rmse_release = 0.0;
  double rmse_press_free = 0.0, rmse_release_free = 0.0;
};

// Least squares over all readings with deflection in [0, limit], each of equal weight. limit: m.
// lowest_slope: N/m, >= 0; the result is accepted by Response with the same. Throws Error on readings that
// are not finite or do not determine the curves.
[[nodiscard]] ResponseFit fit_response(std::span<const LoopPoint> loop, double limit, double lowest_slope);

}  // namespace enc::models
