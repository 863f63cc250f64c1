// models/responses/*.toml: the force of an object, as measured on a rig (sources/choices 9). load_response()
// of models/setup/scene_file.h reads it; `encounter fit` writes it with response_text().
//
//   format = 1
//   source = "where the numbers come from"
//   limit_mm = 6                               # the polynomials hold from 0 to here
//   press_N_per_mm_k = [0.6, 0.4, -0.1, 0.01]  # F = sum of a_k d^k, k = 1..4: N/mm, N/mm^2, N/mm^3, N/mm^4
//   release_N_per_mm_k = [0.3, 0.2, 0.1, 0.01]
//
//   [stops]                           # optional: for reversal = "prandtl_ishlinskii", see
//   curve_N = [1.2, 3.4, 0.5]         # core/shape/response/response.h; sum of c_k (d / limit)^k
//   radii_mm = [0.2, 0.5, 1]
//   weights_N_per_mm = [1, 0.5, 0.2]  # at the limit; in proportion to the deflection before it
#pragma once

#include <cstdint>
#include <string>

#include "core/shape/response/response.h"

namespace enc::models {

struct ResponseFile {
  std::int64_t format = 1;
  std::string source;
  ResponseSpec response;
};

// The file's whole text. A text that was read and written again is unchanged.
std::string response_text(const ResponseSpec& response, const std::string& source);

}  // namespace enc::models
