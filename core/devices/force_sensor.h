// A six-axis force/torque sensor between the machine and its haptic-tip [VHMR 2].
#pragma once

#include "core/sample.h"

namespace enc {

class ForceSensor {
 public:
  virtual ~ForceSensor() = default;
  virtual Stamped<Wrench> read() noexcept = 0;  // newest; raw: weight, inertia and zero error are still in it
};

}  // namespace enc
