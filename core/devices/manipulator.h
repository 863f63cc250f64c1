// A position-controlled machine that carries the haptic-tip: the hexapod [VHMR 2].
#pragma once

#include "core/base/sample.h"
#include "core/devices/device.h"
#include "core/machine/reach.h"

namespace enc {

class Manipulator : public Device {
 public:
  [[nodiscard]] virtual Reach reach() const = 0;           // called once, before anything moves
  virtual Stamped<TipSample> read(Time now) noexcept = 0;  // newest; never blocks
  // Set-point for the coming period, computed from the last read().
  virtual void command(const Pose<'R', 'H'>& X_RH) noexcept = 0;
  // Brings the machine to rest where it is. The run calls this when it ends, however it ends, and maybe more
  // than once; a command afterwards starts anew.
  virtual void stop() noexcept = 0;
};

// The farthest reachable pose on the straight path to the wanted one, for a device that limits its commands
// so.
[[nodiscard]] inline Pose<'R', 'H'> clamped(const Reach& reach, const Pose<'R', 'H'>& from,
                                            const Pose<'R', 'H'>& wanted) noexcept {
  if (reach.contains(wanted)) return wanted;
  Pose<'R', 'H'> best = from;
  double low = 0.0, high = 1.0;  // shares of the path
  for (int i = 0; i < 30; ++i) {
    const double share = 0.5 * (low + high);
    const Pose<'R', 'H'> between(from.q().slerp(share, wanted.q()),
                                 Vec3(from.p() + share * (wanted.p() - from.p())));
    const bool reached = reach.contains(between);
    if (reached) best = between;
    (reached ? low : high) = share;
  }
  return best;
}

}  // namespace enc
