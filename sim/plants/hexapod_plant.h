// The hexapod's servo as it moves: command delay, lag, speed and acceleration limits, its step, its stroke.
// Control form: the pose is prescribed to the physics, which is right because the drives are not
// back-drivable [sources/twin 1]. Structural form: it sets the legs' free lengths (legs.h).
#pragma once

#include <array>
#include <cstdint>

#include "core/base/sample.h"
#include "core/machine/reach.h"
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
  struct Pending {
    std::array<Pose<'R', 'H'>, kLongestDelay> line;  // commands on their way, ring
    std::int64_t head = 0;
  };
  // Everything that moves; trivially copyable, so that a world can be saved.
  struct State {
    Pending pending;
    Pose<'R', 'H'> newest;  // last accepted command
    Pose<'R', 'H'> wanted;  // servo set-point, in steps
    Pose<'R', 'H'> pose;
    Vec<'R'> velocity = Vec<'R'>::zero();
    Vec<'R'> acceleration = Vec<'R'>::zero();
    Vec<'R'> turning = Vec<'R'>::zero();  // angular velocity
    // What the encoders do not see: by how much the platform misses the servo's pose. Drawn anew with each
    // new set-point, so that every move ends a little elsewhere; it comes as slowly as the servo.
    Vec<'R'> play = Vec<'R'>::zero(), play_due = Vec<'R'>::zero();
    Stream noise;
    Health health = Health::ok;
    bool led = false;  // it is where lead() says, whatever it is told
  };

  HexapodPlant(const HexapodTruth& truth, std::uint64_t seed);

  [[nodiscard]] const Hexapod& machine() const { return machine_; }
  [[nodiscard]] const State& state() const { return state_; }
  [[nodiscard]] Pose<'R', 'H'> true_pose() const noexcept;  // the servo's, with play
  void restore(const State& state) { state_ = state; }
  // The set-point for the coming cycle. Not finite: refused (health fault). Out of reach: clamped on the way
  // (health out_of_range).
  void command(const Pose<'R', 'H'>& X_RH) noexcept;
  // Another machine moves in its place and was seen so: from the next step on it is there.
  void lead(const TipSample& seen) noexcept;
  void begin_cycle() noexcept;          // the command of `delay_cycles` ago becomes the servo's
  void move(double timestep) noexcept;  // servo over one physics step

 private:
  void follow_rotation(double timestep) noexcept;

  HexapodTruth truth_;
  Hexapod machine_;
  State state_;
};

}  // namespace enc::sim
