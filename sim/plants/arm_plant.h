// The arm's electronics: encoders with counts, a force command that becomes joint torques by J^T F, motors
// with a peak torque and a winding temperature, a watchdog; and the prop's gimbal and motor. [sources/arm 3]
#pragma once

#include <array>
#include <cstdint>

#include "core/base/sample.h"
#include "core/devices/device.h"
#include "core/machine/motors.h"
#include "sim/spec/arm_spec.h"

namespace enc::sim {

class ArmPlant {
 public:
  static constexpr std::size_t kLongestWindow = 64;  // ticks
  struct State {
    Measurement<ArmSample> sample;
    std::array<PerJoint, kLongestWindow> read{};  // joint readings, a ring
    std::int64_t reads = 0;
    Vec<'R'> wanted = Vec<'R'>::zero();  // last command
    double silent = 0.0;                 // s since the last command
    bool commanded = false;
    PerJoint torque{};  // joint torques for the present period
    // Rise of each winding over its housing, and of the housing over the room, as shares of the continuously
    // allowed rise of the winding over the room.
    PerJoint winding{}, housing{};
    bool clipped = false;                              // a motor limit reduced the command
    std::array<double, 4> facing{0, 0, 0, 1};          // prop's front, q_WN, xyzw
    double surface_wanted = 0.0, surface_speed = 0.0;  // driven front, m/s
    Vec<'R'> facing_wanted;  // commanded direction of the front; unset: no command yet
  };

  // believed: the device's kinematics, from the rig file. dt: of a tick, s. Throws Error if the velocity
  // window is longer than 64 ticks.
  ArmPlant(const ArmTruth& truth, const Arm& believed, double dt);

  [[nodiscard]] const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }
  [[nodiscard]] Quat facing() const {
    return {state_.facing[3], state_.facing[0], state_.facing[1], state_.facing[2]};
  }

  // Rise of a winding over the room, as a share of the continuously allowed one.
  [[nodiscard]] double warmth(std::size_t joint) const {
    return state_.winding[joint] + state_.housing[joint];
  }
  // Call once a tick: reads the encoders at the true joints.
  void measure(Time t, const PerJoint& joints) noexcept;
  // Holds until the next command, or until the watchdog cancels it. A force that is not finite is refused
  // (health fault).
  void command(const Vec<'R'>& force) noexcept;
  void move_prop(const PropCommand& prop) noexcept;
  // Computes the torques of the coming period from the newest reading, and their heating of the windings.
  void begin_cycle() noexcept;
  // Smooth friction at these rates, N m or N; zeros for dry friction, which the physics handles.
  [[nodiscard]] PerJoint friction(const PerJoint& rates) const noexcept;
  // Motor torques, N m.
  [[nodiscard]] PerJoint motor_torque() const noexcept;
  // Turns the gimbal's front towards a normal over a step; at once if it faced nothing before.
  void face(const Vec3& normal, double h, bool at_once) noexcept;

  // Quantisation step of a joint's encoder, rad or m.
  [[nodiscard]] double step(std::size_t joint) const { return step_[joint]; }

 private:
  [[nodiscard]] double limited(std::size_t joint, double torque) noexcept;

  ArmTruth truth_;
  Arm believed_;
  double dt_;
  MotorHeating warming_;
  std::int64_t window_;  // ticks
  PerJoint step_{};
  State state_;
};

}  // namespace enc::sim
