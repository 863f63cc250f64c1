// Detects a machine that does not follow its commands: compares its pose with the commands, given the lag in
// the rig file. A machine that is off, jammed or scaled wrongly shows no sign in the force.
#pragma once

#include <algorithm>

#include "core/base/frames.h"
#include "core/machine/servo.h"

namespace enc {

// Time for which a machine has been off its commanded path. A fast command allows a larger error, for as long
// as the machine may lag behind that command.
struct PathDeviation {
  double fastest = 0.0;  // m/s
  double off = 0.0;      // s

  // Deviation allowed after recent commands, m. The machine may be twice as slow as its model.
  [[nodiscard]] double excused(double speed, double lag, double dt) noexcept {
    constexpr double kLags = 2.0;
    fastest = std::max(speed, fastest * std::max(0.0, 1.0 - dt / lag));
    return kLags * lag * fastest;
  }
  // Call once a tick. `away`: the machine is off its path in this tick. True once it has been away for
  // `patience`, s.
  [[nodiscard]] bool too_long(bool away, double patience, double dt) noexcept {
    off = away ? off + dt : 0.0;
    return off >= patience;
  }
};

// Memory of follows().
struct FollowingState {
  Point<'R'> expected;  // position of the servo model; unset: not started
  Vec<'R'> velocity = Vec<'R'>::zero();
  PathDeviation deviation;
  bool lost = false;  // off for too long; stays set until the tool leaves
};

// Call once a tick: `command` was sent for this tick, `measured` is the machine's reported position. False
// once the machine has been off for 50 ms: farther than 0.5 mm plus twice the lag from the segment between
// model and command.
[[nodiscard]] bool follows(const ServoModel& servo, const Point<'R'>& command, const Vec<'R'>& velocity,
                           const Point<'R'>& measured, FollowingState& state) noexcept;

}  // namespace enc
