// The solver of the physics: [truth.solver]. A part of twin_spec.h.
#pragma once

#include <cstdint>

#include "core/base/frames.h"
#include "core/base/words.h"

namespace enc::sim {

// MuJoCo's method for contacts and dry friction.
enum class Cone : std::uint8_t { elliptic, pyramidal };
constexpr auto words(Cone) { return enum_words("elliptic", "pyramidal"); }
struct SolverTruth {
  Cone cone = Cone::elliptic;
  double impratio = 20.0;     // friction's impedance over that of the stop: friction without creep
  double noslip = kUnset;     // steps of the pass that removes creep; unset: 4, and 0 with an arm
  double iterations = 100.0;  // most iterations of Newton's method
  double tolerance = 1e-12;   // tolerance of Newton's method
};

}  // namespace enc::sim
