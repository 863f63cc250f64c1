// From a measured loop of deflection and force to a response that an admittance can render: the two
// polynomials [VHMR 4.2], zero at zero, never softer than the loop is stable, press never below release; and
// the stops of the Prandtl-Ishlinskii model.
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
  bool pressing = true;     // else releasing
  double time = 0.0;        // s; the curves do not need it, a law with rate effects does
  bool held = false;  // at standstill: the force relaxes, which a law without rate effects cannot follow
};

// Root mean squares of the residuals, N. "Free": least squares that is zero at zero and nothing else; the
// difference is what the constraints cost.
struct ResponseFit {
  ResponseSpec spec;
  double rmse_press = 0.0, rmse_release = 0.0;
  double rmse_press_free = 0.0, rmse_release_free = 0.0;
  // The constraints move a curve most at this deflection, m: the press or the release. The force there is
  // `measured` without them and `fitted` with them, N.
  double moved_at = 0.0, measured = 0.0, fitted = 0.0;
  bool moved_press = false;
  // The press without constraints has this force at the limit, N.
  double measured_end = 0.0;
};

// Least squares over all readings with deflection in [0, limit], each of equal weight. limit: m.
// lowest_slope: N/m, >= 0; the result is accepted by Response with the same. Throws Error on readings that
// are not finite or do not determine the curves.
[[nodiscard]] ResponseFit fit_response(std::span<const LoopPoint> loop, double limit, double lowest_slope);

struct StopsFit {
  StopsSpec spec;
  double rmse = 0.0;       // N, over both branches
  double rmse_free = 0.0;  // N, weights >= 0 and nothing else
};

// The stops by non-negative least squares. Each press is a path of its own that begins at rest, in the order
// of time; readings that are held count for the path alone. stiffest: N/m, more than which the object never
// is, whichever way it is moved: so that a tremor at rest does not become a large force (see kTremor in the
// .cpp).
[[nodiscard]] StopsFit fit_stops(std::span<const std::vector<LoopPoint>> presses, double limit,
                                 double lowest_slope, double stiffest);

// The slope below which no fitted curve may fall, N/m. See the .cpp for the rule.
[[nodiscard]] double fit_floor(const LoopModel& loop);
// The stiffness beyond which the stops may not go, N/m, beside these press and release curves.
[[nodiscard]] double fit_ceiling(const ResponseSpec& curves);

// The coefficients as a file shows them: rounded, so that the file is the same whatever the compiler did to
// the last bits of the fit.
[[nodiscard]] ResponseSpec rounded(const ResponseSpec& spec);

// For what is known about the coefficients (loop_fit.h): unknowns are the press, then the release
// coefficients of (d / limit)^1..4, N.
[[nodiscard]] Quadratic normal_equations(std::span<const LoopPoint> loop, double limit);
[[nodiscard]] Constraints renderable(double lowest_slope, double limit, double margin);

}  // namespace enc::models
