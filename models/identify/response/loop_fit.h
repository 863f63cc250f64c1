// `encounter fit`: what a measured loop says about a response, and how well.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "models/identify/response/loop_csv.h"

namespace enc::models {

// Half of the width of a 95 % interval stands beside each value.
struct Known {
  double value = 0.0, half = 0.0;
};

struct BranchKnown {
  std::array<Known, 4> coefficients;  // of d^1..d^4, N/m^k
  // N, at 1, 2, ... mm up to the limit: with what noise, repeats, the zero and the polynomial's shape may do.
  std::vector<Known> curve;
  std::vector<double> repeats;  // N, there: half of the interval of the repeats' mean; unset below three
  double condition = 0.0;       // of the normal matrix, its columns scaled to length 1
  std::array<int, 2> tied{};    // which two coefficients (1..4) are hardest to tell apart,
  double correlation = 0.0;     // and how their errors go together
};

struct LoopFit {
  ResponseFit curves;
  StopsFit stops;
  BranchKnown press, release;
  double repeatability = 0.0;     // N: largest spread between repeats at equal deflection and branch
  double repeatability_at = 0.0;  // m
  std::size_t presses = 0, readings = 0;
  double floor = 0.0, ceiling = 0.0;  // N/m: no softer, no stiffer
  ResponseSpec response;              // rounded: what the file says
  std::string source;                 // and where it says it comes from
};

struct LoopFitOptions {
  double limit = 6e-3;
  double floor = 0.0;       // N/m, of fit_floor()
  double ceiling = kUnset;  // N/m; unset: of fit_ceiling()
};

[[nodiscard]] LoopFit fit_loop(const LoopData& loop, const LoopFitOptions& options);

}  // namespace enc::models
