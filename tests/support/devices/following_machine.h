// The simplest machine that may stand behind a fake controller: it is at once where it is told to be.
#pragma once

#include "core/devices/manipulator.h"

namespace enc::test {

struct FollowingMachine final : Manipulator {
  [[nodiscard]] Reach reach() const override { return can; }
  Stamped<TipSample> read(Time now) noexcept override {
    return {{pose, Vec<'R'>::zero(), Vec<'R'>::zero()}, now, Health::ok};
  }
  void command(const Pose<'R', 'H'>& X_RH) noexcept override { pose = X_RH; }
  void stop() noexcept override {}

  Reach can{0.05, 0.41, Hexapod{HexapodGeometry{}}};
  Pose<'R', 'H'> pose = can.machine.zero();
};

}  // namespace enc::test
