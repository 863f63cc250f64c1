// Admittance rendering by a machine that measures force: [admittance] of a rig file. A part of rig_spec.h.
#pragma once

#include <cstdint>

#include "core/base/words.h"
#include "core/spec/passivity_form.h"

namespace enc {

enum class Damping : std::uint8_t {
  none,     // the object alone, as on the paper's rig
  observed  // plus a damper, as strong as the measured oscillation energy requires
};
constexpr auto words(Damping) { return enum_words("none", "observed"); }

struct AdmittanceRig {
  Damping damping = Damping::none;
  PassivityForm passivity = PassivityForm::none;
  double margin = 2.0;          // damping over sufficient damping
  double calm_time = 1.0;       // s, time constant with which damping decays without an oscillation
  double slowest = 1.0;         // Hz: slower changes are the user's own motion
  double average_time = 0.2;    // s, averaging time of energies
  double least_swing = 20e-6;   // m rms: a smaller motion is not an oscillation
  double most_damping = 500.0;  // N s/m
};

}  // namespace enc
