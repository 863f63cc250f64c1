// A position-controlled machine that carries the haptic-tip: the hexapod [VHMR 2].
#pragma once

#include "core/base/sample.h"
#include "core/devices/device.h"
#include "core/machine/reach.h"

namespace enc {

class Manipulator : public Device {
 public:
  [[nodiscard]] virtual Reach reach() const = 0;           // asked once, before anything moves
  virtual Stamped<TipSample> read(Time now) noexcept = 0;  // newest; never blocks
  virtual void command(const Pose<'R', 'H'>&
                           X_RH) noexcept = 0;  // set-point for the coming period, made of what was read last
  // Comes to rest where it is. Called when a run ends, however it ends, and maybe more than once; a command
  // after it starts anew.
  virtual void stop() noexcept = 0;
};

// The farthest pose within reach on the straight way to the wanted one, for a device that clamps to it.
[[nodiscard]] inline Pose<'R', 'H'> clamped(const Reach& reach, const Pose<'R', 'H'>& from,
                                            const Pose<'R', 'H'>& wanted) noexcept {
  if (reach.contains(wanted)) return wanted;
  Pose<'R', 'H'> best = from;
  double low = 0.0, high = 1.0;  // shares of the way
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
