// How a machine that measures force renders an object: [admittance] of a rig file. A part of rig_spec.h.
#pragma once

#include <cstdint>

#include "core/base/words.h"
#include "core/spec/passivity_form.h"

namespace enc {

enum class Damping : std::uint8_t {
  none,     // the object alone, as on the paper's rig
  observed  // and a damper, as strong as the energy that is seen to swing asks for
};
constexpr auto words(Damping) { return enum_words("none", "observed"); }

struct AdmittanceRig {
  Damping damping = Damping::none;
  PassivityForm passivity = PassivityForm::none;
  double margin = 2.0;          // of the damping over what suffices
  double calm_time = 1.0;       // s, in which damping falls to 1/e when nothing swings
  double slowest = 1.0;         // Hz: slower changes are the user's own
  double average_time = 0.2;    // s, over which energies are averaged
  double least_swing = 20e-6;   // m rms: smaller ones do not count as a swing
  double most_damping = 500.0;  // N s/m
};

}  // namespace enc
