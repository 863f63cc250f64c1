#include "hw_drivers/gripper/drive/jaws.h"

#include <algorithm>

namespace enc::gripper {

void Jaws::drive(Drive drive, Duration now) noexcept {
  drive_ = drive;
  since_ = now;
  before_ = sample_.opening;
}

// Without a drive the jaws rest: only the sensors say where.
void Jaws::take(const Sensors& sensors, Duration now) noexcept {
  const double whole = 2.0 * settings_.stroke, moved = whole * seconds(now - since_) / settings_.closing_time;
  const bool late = seconds(now - since_) > settings_.longest_stroke;
  stuck_ = sensors.open && sensors.gripped;
  sample_.holding = sensors.gripped && !sensors.open && drive_ != Drive::open;
  sample_.force = sample_.holding ? settings_.force : 0.0;
  if (sensors.open && drive_ != Drive::close) {
    sample_.phase = GripPhase::open;
    sample_.opening = whole;
  } else if (sample_.holding) {
    sample_.phase = GripPhase::closed;
    sample_.opening = settings_.width;
  } else if (drive_ == Drive::close) {
    stuck_ = stuck_ || (late && sensors.open);
    sample_.phase = late ? GripPhase::closed : GripPhase::closing;
    sample_.opening = late ? 0.0 : std::max(0.0, before_ - moved);
  } else if (drive_ == Drive::open) {
    stuck_ = stuck_ || late;
    sample_.phase = GripPhase::opening;
    sample_.opening = std::min(whole, before_ + moved);
  }
}

}  // namespace enc::gripper
