// The hexapod's servo: command delay, lag, speed and acceleration limits, quantisation step, stroke. Control
// form: the pose is prescribed to the physics, which is right because the drives are not back-drivable
// [sources/twin 1]. Structural form: it sets the legs' free lengths (legs.h).
#pragma once

#include <array>
#include <cstdint>

#include "core/base/sample.h"
#include "core/machine/hexapod.h"
#include "core/machine/servo.h"
#include "sim/spec/twin_spec.h"
#include "sim/truth/random.h"

namespace enc::sim {

[[nodiscard]] inline ServoLaw servo_of(const HexapodTruth& truth) noexcept {
  return {truth.servo, truth.damping, truth.speed, truth.acceleration};
}

class HexapodPlant {
 public:
  static constexpr std::size_t kLongestDelay = 64;  // cycles
  struct PendingCommands {
    std::array<Pose<'R', 'H'>, kLongestDelay> line;  // pending commands, a ring
    std::int64_t head = 0;
  };
  // All moving state; trivially copyable, so that a world can be saved.
  struct State {
    PendingCommands pending;
    Pose<'R', 'H'> newest;  // last accepted command
    Pose<'R', 'H'> wanted;  // servo set-point, quantised
    Pose<'R', 'H'> pose;
    Vec<'R'> velocity = Vec<'R'>::zero();
    Vec<'R'> acceleration = Vec<'R'>::zero();
    Vec<'R'> turning = Vec<'R'>::zero();  // angular velocity
    // Error of the platform against the servo's pose, invisible to the encoders. It is drawn anew with each
    // new set-point, so that every move ends a little elsewhere; it changes as slowly as the servo.
    Vec<'R'> play = Vec<'R'>::zero(), play_due = Vec<'R'>::zero();
    Stream noise;
    Health health = Health::ok;
    bool led = false;  // lead() sets its pose, and commands are ignored
  };

  HexapodPlant(const HexapodTruth& truth, std::uint64_t seed);

  [[nodiscard]] const Hexapod& machine() const { return machine_; }
  [[nodiscard]] const State& state() const { return state_; }
  [[nodiscard]] Pose<'R', 'H'> true_pose() const noexcept;  // servo's pose plus play
  void restore(const State& state) { state_ = state; }
  // The set-point for the coming cycle. Not finite: refused (health fault). Out of reach: clamped on the path
  // (health out_of_range).
  void command(const Pose<'R', 'H'>& X_RH) noexcept;
  // Another machine moves in its place and was measured there: from the next step on, this pose follows.
  void lead(const TipSample& seen) noexcept;
  void begin_cycle() noexcept;          // the command of `delay_cycles` ago reaches the servo
  void move(double timestep) noexcept;  // moves the servo over one physics step

 private:
  void follow_rotation(double timestep) noexcept;

  HexapodTruth truth_;
  Hexapod machine_;
  State state_;
};

}  // namespace enc::sim
