// `encounter fit`: a response from a measured loop, with its uncertainty.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "models/identify/response/loop_csv.h"

namespace enc::models {

// A value and half of the width of its 95 % interval.
struct LoopEstimate {
  double value = 0.0, half = 0.0;
};

struct BranchEstimate {
  std::array<LoopEstimate, 4> coefficients;  // coefficients of d^1..d^4, N/m^k
  // N, at 1, 2, ... mm up to the limit: includes noise, repeats, the zero and the polynomial's shape.
  std::vector<LoopEstimate> curve;
  // N, at these depths: half of the interval of the repeats' mean; unset for fewer than three repeats.
  std::vector<double> repeats;
  double condition = 0.0;     // condition of the normal matrix, its columns scaled to length 1
  std::array<int, 2> tied{};  // the two coefficients (1..4) that are hardest to separate
  double correlation = 0.0;   // correlation of their errors
};

struct LoopFit {
  ResponseFit curves;
  StopsFit stops;
  BranchEstimate press, release;
  double repeatability = 0.0;     // N: largest spread between repeats at equal deflection and branch
  double repeatability_at = 0.0;  // m
  std::size_t presses = 0, readings = 0;
  double floor = 0.0, ceiling = 0.0;  // N/m: lower and upper stiffness limit
  ResponseSpec response;              // rounded, as in the file
  std::string source;                 // its origin, as in the file
};

struct LoopFitOptions {
  double limit = 6e-3;
  double floor = 0.0;       // N/m, from fit_floor()
  double ceiling = kUnset;  // N/m; unset: from fit_ceiling()
};

[[nodiscard]] LoopFit fit_loop(const LoopData& loop, const LoopFitOptions& options);

}  // namespace enc::models
