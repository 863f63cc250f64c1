// Errors of a fitted curve besides noise: repeats differ, the zero of the force and the begin of contact are
// uncertain, and a polynomial cannot follow every curve.
#pragma once

#include <vector>

#include "core/shape/response/response.h"
#include "models/identify/response/loop_csv.h"

namespace enc::models {

class CurveErrors {
 public:
  CurveErrors(const LoopData& loop, const Response& response, bool pressing);

  // Half of the 95 % interval at a deflection, N; `noise`: half of the interval from noise alone. The
  // polynomial's misfit is not random, so it is added linearly.
  [[nodiscard]] double half(double deflection, double noise) const;

 private:
  struct Residual {
    double deflection = 0.0, force = 0.0;  // m, N
  };
  [[nodiscard]] double misfit(double deflection) const;
  [[nodiscard]] double misfit_within(double deflection, double width) const;
  [[nodiscard]] double slope(double deflection) const;  // N/m

  Response response_;
  bool pressing_;
  std::vector<Residual> residuals_;  // sorted by deflection
  double scatter_ = 0.0;             // N: standard deviation of a residual
  double repeats_ = 0.0;             // N: half of the interval of the repeats' mean, as whole branches
  double zero_, begin_;              // N, m: standard deviations
};

}  // namespace enc::models
