// How the physics solves: [truth.solver]. A part of twin_spec.h.
#pragma once

#include <cstdint>

#include "core/base/frames.h"
#include "core/base/words.h"

namespace enc::sim {

// How MuJoCo solves contacts and dry friction.
enum class Cone : std::uint8_t { elliptic, pyramidal };
constexpr auto words(Cone) { return enum_words("elliptic", "pyramidal"); }
struct SolverTruth {
  Cone cone = Cone::elliptic;
  double impratio = 20.0;     // of friction's impedance to that of the stop: friction that does not creep
  double noslip = kUnset;     // steps of the pass that takes out creep; unset: 4, and none with an arm
  double iterations = 100.0;  // of Newton's method, at most
  double tolerance = 1e-12;   // where it ends
};

}  // namespace enc::sim
