// A force-controlled arm that carries a prop to where a finger will touch: the PHANToM [VisHap 2.3].
#pragma once

#include "core/base/sample.h"
#include "core/devices/device.h"
#include "core/spec/arm_rig.h"

namespace enc {

struct PropCommand {
  double surface_speed = 0.0;  // of its surface against the prop, m/s
  Vec<'R'> facing;             // that its front shall face, unit; unset: as it does
};

class HapticArm : public Device {
 public:
  [[nodiscard]] virtual ArmAbility ability() const = 0;    // asked once, before anything moves
  virtual Stamped<ArmSample> read(Time now) noexcept = 0;  // newest; never blocks
  // Force that the tip shall exert on what touches it, gravity included: stays until the next one. The device
  // makes joint torques of it (J^T F) and clips them to what its motors can.
  virtual void command(const Vec<'R'>& force) noexcept = 0;
  virtual void stop() noexcept = 0;  // pushes no more, and whatever it drives stands; see Manipulator
  // Of a prop that has motors of its own; others have nothing to move.
  virtual void move_prop([[maybe_unused]] const PropCommand& prop) noexcept {}
};

}  // namespace enc
