// A force-controlled arm that carries a prop to where a finger will touch: the PHANToM [VisHap 2.3].
#pragma once

#include "core/base/sample.h"
#include "core/devices/device.h"
#include "core/spec/arm_rig.h"

namespace enc {

struct PropCommand {
  double surface_speed = 0.0;  // object's surface against the prop, m/s
  Vec<'R'> facing;             // commanded direction of the prop's front, unit; unset: keep it
};

class HapticArm : public Device {
 public:
  [[nodiscard]] virtual ArmAbility ability() const = 0;    // called once, before anything moves
  virtual Stamped<ArmSample> read(Time now) noexcept = 0;  // newest; never blocks
  // Commanded force of the tip on its surroundings, including gravity compensation; stays in force until the
  // next command. The device converts it to joint torques (J^T F) and limits these to its motors.
  virtual void command(const Vec<'R'>& force) noexcept = 0;
  virtual void stop() noexcept = 0;  // Ends all force and stops every driven part; see Manipulator.
  // Only for a prop with its own motors; other props do nothing.
  virtual void move_prop([[maybe_unused]] const PropCommand& prop) noexcept {}
};

}  // namespace enc
