// Whether a machine does what it is told: its pose against the commands, with the lag that the rig file
// believes. A machine that is off, jammed or at another scale moves nothing that a force could tell.
#pragma once

#include "core/frames.h"

namespace enc {

// What a position-controlled machine answers with, as the rig believes.
struct ServoModel {
  double frequency = kUnset;  // natural, rad/s
  double damping = kUnset;    // ratio
  double delay = 0.0;         // s
  // s, of an even motion; no belief makes a machine slower than kSlowest.
  static constexpr double kSlowest = 0.1;
  [[nodiscard]] double lag() const {
    const double lag = 2.0 * damping / frequency + delay;
    return lag < kSlowest ? lag : kSlowest;
  }
};

// What is remembered. The fastest command counts for as long as the machine may lag behind it.
struct Following {
  Point<'R'> expected;  // where the model of the servo is; unset: nothing is known yet
  Vec<'R'> velocity = Vec<'R'>::zero();
  double fastest = 0.0;  // m/s
  double off = 0.0;      // s for which the machine has been elsewhere
  bool lost = false;     // it was for too long: until the tool has gone
};

// A tick: `command` is what was sent for it, `measured` where the machine says it is. False: it has been
// farther than 0.5 mm and twice the lag from all that is between the model and the command for 50 ms.
[[nodiscard]] bool follows(const ServoModel& servo, const Point<'R'>& command, const Vec<'R'>& velocity,
                           const Point<'R'>& measured, double dt, Following& state) noexcept;

}  // namespace enc
