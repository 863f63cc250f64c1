// The physics: its solver, its time step and the contact of tool and tip, [truth.solver] and [truth.world]. A
// part of twin_spec.h.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

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

struct WorldTruth {
  double timestep = 0.001;  // s
  std::string integrator = "implicitfast";
  double tip_friction = 0.6;    // tool on haptic-tip
  double contact_time = 0.005;  // s, stop between tool and tip: hard, not a rendered stiffness
};

struct Stepping {
  double timestep;  // s
  std::string integrator;
  std::string table;  // table of the file with both keys

  // Physics steps in a haptic period (rate in Hz); 0 if the time step does not divide it.
  [[nodiscard]] int steps_per_tick(double rate) const {
    const double steps = 1.0 / (rate * timestep);
    const double whole = std::round(steps);
    return whole >= 1.0 && std::abs(steps - whole) <= 1e-6 * whole ? static_cast<int>(whole) : 0;
  }
};

}  // namespace enc::sim
