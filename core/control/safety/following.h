// Whether a machine does what it is told: its pose against the commands, with the lag that the rig file
// believes. A machine that is off, jammed or at another scale moves nothing that a force could tell.
#pragma once

#include <algorithm>

#include "core/base/frames.h"
#include "core/machine/servo.h"

namespace enc {

// How long something has been elsewhere than it was sent. A fast command excuses more, for as long as one may
// lag behind it.
struct Straying {
  double fastest = 0.0;  // m/s
  double off = 0.0;      // s

  // m that the commands of late excuse; a machine may be twice as slow as is believed.
  [[nodiscard]] double excused(double speed, double lag, double dt) noexcept {
    constexpr double kLags = 2.0;
    fastest = std::max(speed, fastest * std::max(0.0, 1.0 - dt / lag));
    return kLags * lag * fastest;
  }
  // A tick on which it is away, or is not: whether it has been for so long, s.
  [[nodiscard]] bool too_long(bool away, double patience, double dt) noexcept {
    off = away ? off + dt : 0.0;
    return off >= patience;
  }
};

// What is remembered.
struct Following {
  Point<'R'> expected;  // where the model of the servo is; unset: nothing is known yet
  Vec<'R'> velocity = Vec<'R'>::zero();
  Straying straying;
  bool lost = false;  // it was for too long: until the tool has gone
};

// A tick: `command` is what was sent for it, `measured` where the machine says it is. False: it has been
// farther than 0.5 mm and twice the lag from all that is between the model and the command for 50 ms.
[[nodiscard]] bool follows(const ServoModel& servo, const Point<'R'>& command, const Vec<'R'>& velocity,
                           const Point<'R'>& measured, Following& state) noexcept;

}  // namespace enc
