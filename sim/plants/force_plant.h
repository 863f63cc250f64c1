// Readings of the force/torque sensor: MuJoCo's sensor pair plus the inertia that a placed body does not
// show, zero error and drift, noise, quantisation and range. [VHMR 2, sources/force_sensor 1]
#pragma once

#include "core/base/sample.h"
#include "sim/spec/twin_spec.h"
#include "sim/truth/random.h"

namespace enc::sim {

class ForcePlant {
 public:
  struct State {
    Stream noise;
    Vec<'F'> zero = Vec<'F'>::zero();      // N
    Vec<'F'> shifted = Vec<'F'>::zero();   // N, in this push
    Vec<'F'> shifting = Vec<'F'>::zero();  // N/s, during the next
    double shift_left = 0.0;               // remaining s
    Stamped<Wrench> sample;
  };
  ForcePlant(const ForceTruth& truth, std::uint64_t seed);

  [[nodiscard]] const Stamped<Wrench>& sample() const { return state_.sample; }
  [[nodiscard]] const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }
  void begin_push() noexcept;  // the zero differs from that of the last push
  [[nodiscard]] Vec<'F'> zero() const { return state_.zero + state_.shifted; }
  // raw: force and torque on the sensor in its true axes; inertia: m a of the mass behind it, in those axes.
  // Once a tick.
  void measure(Time t, double dt, const Wrench& raw, const Vec<'F'>& inertia);

 private:
  ForceTruth truth_;
  Quat turned_;  // rotation from the true sensor axes to the rig's
  State state_;
};

}  // namespace enc::sim
