// Fits a response that an admittance can render to a measured loop of deflection and force. The result has
// two polynomials [VHMR 4.2], zero at zero, never softer than the stable limit of the loop, press never below
// release. It also has the stops of the Prandtl-Ishlinskii model.
#pragma once

#include <span>
#include <vector>

#include "core/machine/loop_model.h"
#include "core/shape/response/response.h"
#include "models/least_squares.h"

namespace enc::models {

struct LoopPoint {
  double deflection = 0.0;  // m
  double force = 0.0;       // N
  bool pressing = true;     // false: releasing
  double time = 0.0;        // s; the curves do not need it, a law with rate effects does
  // True at standstill: the force relaxes, which a law without rate effects cannot follow.
  bool held = false;
};

// Root mean squares of the residuals, N. "Free": least squares with only the condition of zero at zero; the
// difference is the cost of the constraints.
struct ResponseFit {
  ResponseSpec spec;
  double rmse_press = 0.0, rmse_release = 0.0;
  double rmse_press_free = 0.0, rmse_release_free = 0.0;
  // Deflection at which the constraints move a curve most, m: the press or the release. The force there is
  // `measured` without them and `fitted` with them, N.
  double moved_at = 0.0, measured = 0.0, fitted = 0.0;
  bool moved_press = false;
  // Force of the unconstrained press at the limit, N.
  double measured_end = 0.0;
};

// Least squares over all readings with deflection in [0, limit], equally weighted. limit: m. lowest_slope:
// N/m, >= 0; Response accepts the result with this slope. Throws Error for readings that are not finite or do
// not determine the curves.
[[nodiscard]] ResponseFit fit_response(std::span<const LoopPoint> loop, double limit, double lowest_slope);

struct StopsFit {
  StopsSpec spec;
  double rmse = 0.0;       // N, over both branches
  double rmse_free = 0.0;  // N, only weights >= 0
};

// The stops by non-negative least squares. Each press is a separate path that begins at rest, in order of
// time; held readings count only for the path. stiffest: N/m, upper limit of the object's stiffness in any
// direction of motion. It keeps a tremor at rest from becoming a large force (see kTremor in the .cpp).
[[nodiscard]] StopsFit fit_stops(std::span<const std::vector<LoopPoint>> presses, double limit,
                                 double lowest_slope, double stiffest);

// Lower limit of a fitted curve's slope, N/m. See the .cpp for the rule.
[[nodiscard]] double fit_floor(const LoopModel& loop);
// Upper limit of the stops' stiffness, N/m, in addition to these press and release curves.
[[nodiscard]] double fit_ceiling(const ResponseSpec& curves);

// The coefficients as in a file: rounded, so that the file does not depend on the compiler's last bits.
[[nodiscard]] ResponseSpec rounded(const ResponseSpec& spec);

// Inputs of the uncertainty of the coefficients (loop_fit.h). Unknowns are the press, then the release
// coefficients of (d / limit)^1..4, N.
[[nodiscard]] Quadratic normal_equations(std::span<const LoopPoint> loop, double limit);
[[nodiscard]] Constraints renderable(double lowest_slope, double limit, double margin);

}  // namespace enc::models
