// The arm's electronics: encoders that count, a force command that becomes joint torques by J^T F, motors
// with a peak torque and a winding that gets warm, a watchdog; and the prop's own gimbal and motor.
// [sources/arm 3]
#pragma once

#include <array>
#include <cstdint>

#include "core/base/sample.h"
#include "core/devices/haptic_arm.h"
#include "core/machine/motors.h"
#include "sim/spec/arm_spec.h"

namespace enc::sim {

class ArmPlant {
 public:
  static constexpr std::size_t kLongestWindow = 64;  // ticks
  struct State {
    Stamped<ArmSample> sample;
    std::array<PerJoint, kLongestWindow> read{};  // joints as they were read, ring
    std::int64_t reads = 0;
    Vec<'R'> wanted = Vec<'R'>::zero();  // last command
    double silent = 0.0;                 // s since then
    bool commanded = false;
    PerJoint torque{};  // at the joints, for the present period
    // Rise of each winding over its housing and of that over the room, as shares of what the winding may have
    // over the room for ever.
    PerJoint winding{}, housing{};
    bool clipped = false;                              // a motor could not do what was asked
    std::array<double, 4> facing{0, 0, 0, 1};          // of the prop's front, q_WN, xyzw
    double surface_wanted = 0.0, surface_speed = 0.0;  // of a driven front, m/s
    Vec<'R'> facing_wanted;                            // that the front was told to face; unset: nothing yet
  };

  // believed: kinematics that the device computes with, the rig file's. dt: of a tick, s. Throws Error where
  // the velocity window is longer than 64 ticks.
  ArmPlant(const ArmTruth& truth, const Arm& believed, double dt);

  [[nodiscard]] const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }
  [[nodiscard]] Quat facing() const {
    return {state_.facing[3], state_.facing[0], state_.facing[1], state_.facing[2]};
  }

  // Of a winding over the room, as a share of what it may have for ever.
  [[nodiscard]] double warmth(std::size_t joint) const {
    return state_.winding[joint] + state_.housing[joint];
  }
  // Once a tick: encoders are read at the true joints.
  void measure(Time t, const PerJoint& joints) noexcept;
  // Stays until the next one, or until the watchdog takes it away. Not finite: refused (health fault).
  void command(const Vec<'R'>& force) noexcept;
  void move_prop(const PropCommand& prop) noexcept;
  // Torques of the coming period, from the newest reading, and what they do to the windings.
  void begin_cycle() noexcept;
  // Friction of the smooth form at these rates, N m or N; zeros of the dry one, which is the physics'.
  [[nodiscard]] PerJoint friction(const PerJoint& rates) const noexcept;
  // Motor torques, N m.
  [[nodiscard]] PerJoint motor_torque() const noexcept;
  // The gimbal turns its front towards a normal over a step; at once where it faced nothing before.
  void face(const Vec3& normal, double h, bool at_once) noexcept;

  // Smallest change of a joint that its encoder sees, rad or m.
  [[nodiscard]] double step(std::size_t joint) const { return step_[joint]; }

 private:
  [[nodiscard]] double limited(std::size_t joint, double torque) noexcept;

  ArmTruth truth_;
  Arm believed_;
  double dt_;
  Warming warming_;
  std::int64_t window_;  // ticks
  PerJoint step_{};
  State state_;
};

}  // namespace enc::sim
