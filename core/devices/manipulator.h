// A position-controlled machine that carries the haptic-tip: the hexapod [VHMR 2].
#pragma once

#include "core/machine/reach.h"
#include "core/sample.h"

namespace enc {

class Manipulator {
 public:
  virtual ~Manipulator() = default;
  [[nodiscard]] virtual Reach reach() const = 0;                  // asked once, before anything moves
  virtual Stamped<TipSample> read(Time now) noexcept = 0;         // newest; never blocks
  virtual void command(const Pose<'R', 'H'>& X_RH) noexcept = 0;  // set-point for the coming period
};

}  // namespace enc
