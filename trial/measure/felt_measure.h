// What the core itself knows of a press, for runs in which nobody knows the truth.
#pragma once

#include <algorithm>

#include "trial/trial.h"

namespace enc::trial {

struct FeltMeasure {
  bool truth = true;     // every device is simulated: others know better
  double peak = 0.0;     // N, along the normal, in contact
  double deepest = 0.0;  // m, as the machine was told

  void see(const Glance& glance) {
    truth = glance.simulated;
    if (glance.out.mode != Mode::contact) return;
    peak = std::max(peak, -glance.out.force.xyz[2]);
    deepest = std::max(deepest, glance.out.deflection);
  }
};

}  // namespace enc::trial
