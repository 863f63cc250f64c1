// A six-axis force/torque sensor between the machine and its haptic-tip [VHMR 2].
#pragma once

#include "core/base/sample.h"
#include "core/devices/device.h"

namespace enc {

class ForceSensor : public Device {
 public:
  // The newest sample; never blocks. It is raw: weight, inertia and zero error are still in it.
  virtual Stamped<Wrench> read(Time now) noexcept = 0;
};

}  // namespace enc
