// The core and a machine with dead time, lag and limits, whose tip is pushed along z.
#pragma once

#include <random>

#include "sim/plants/hexapod_plant.h"
#include "tests/support/scenes.h"

namespace enc::test {

class PushedMachine {
 public:
  // A wall that rises to 15 mm above W's origin; a noise of 0.015 N rides on the force.
  PushedMachine(Scene scene, std::uint64_t seed)
      : loop_(std::move(scene)), machine_(sim::HexapodTruth{}, seed), random_(seed) {
    loop_.spoil = [this](Inputs& in) {
      in.tip.value = {machine_.true_pose(), machine_.state().velocity, machine_.state().acceleration};
    };
    loop_.scene.force.mass = 0.0;  // the sensor of this loop stands on the tip
  }
  PushedMachine(const PushedMachine&) = delete;
  PushedMachine& operator=(const PushedMachine&) = delete;

  // m, of the tip in the wall, true; and m/s, of it outwards.
  [[nodiscard]] double depth() const {
    return 0.015 - (loop_.scene.X_WR * machine_.true_pose().origin()).xyz[2] - loop_.scene.tip_radius;
  }
  [[nodiscard]] double velocity() const { return machine_.state().velocity.xyz[2]; }

  void tick(double push) {  // N, downwards
    loop_.force = Vec<'W'>(0, 0, -push - noise_(random_));
    loop_.tick();
    machine_.command(loop_.out.tip);
    machine_.begin_cycle();
    machine_.move(1e-3);
  }

 private:
  Loop loop_;
  sim::HexapodPlant machine_;
  std::mt19937_64 random_;
  std::normal_distribution<double> noise_{0.0, 0.015};
};

}  // namespace enc::test
