// Motion of the gripper: jaws that close at constant speed until they meet an object or each other, then
// press with the set force. [VHMR 4.1, sources/force_sensor 4] The clamped tool is part of the tip's body
// from the start: until the jaws are closed, a person holds it there.
#pragma once

#include "core/base/sample.h"
#include "sim/spec/twin_spec.h"
#include "sim/truth/random.h"

namespace enc::sim {

class GripperPlant {
 public:
  struct State {
    Stream noise;
    Grip wanted;
    double play = 0.0;  // m: position error of this closing
    Stamped<GripSample> sample;
  };
  GripperPlant(const GripperTruth& truth, std::uint64_t seed);

  [[nodiscard]] const Stamped<GripSample>& sample() const { return state_.sample; }
  [[nodiscard]] const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }
  // A force that is not a number is refused (health fault); one beyond the range is clamped (out_of_range).
  void command(const Grip& grip) noexcept;
  void advance(Time t, double dt) noexcept;  // once a tick

 private:
  [[nodiscard]] double stop() const noexcept;  // opening at which the jaws stop, m
  void begin(bool closing) noexcept;

  GripperTruth truth_;
  State state_;
};

}  // namespace enc::sim
