// A gripper between force sensor and tip that clamps a tool [VHMR 4.1].
#pragma once

#include "core/base/sample.h"
#include "core/devices/device.h"

namespace enc {

class Gripper : public Device {
 public:
  virtual Stamped<GripSample> read(Time now) noexcept = 0;  // newest; never blocks
  // Stays in force until the next command; the device limits the force to its range.
  virtual void command(const Grip& grip) noexcept = 0;
  virtual void stop() noexcept = 0;  // Keeps its grip and opens nothing; see Manipulator.
};

}  // namespace enc
