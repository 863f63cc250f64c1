// The hand tracker on the headset: a skeleton of the simulated user's hand, with rate, latency and noise
// [VHMR 3.2; sources/hand 7].
#pragma once

#include <array>

#include "core/base/hand_sample.h"
#include "core/base/sample.h"
#include "sim/spec/sensor_spec.h"
#include "sim/spec/twin_spec.h"
#include "sim/truth/random.h"

namespace enc::sim {

// The true hand: where its index finger ends, and the direction in which it points, unit.
struct HandPlace {
  Point<'W'> tip;
  Vec<'W'> pointing;
};

// The hand that holds a tool of this length, m; 0: a bare finger.
[[nodiscard]] HandPlace holding(const Point<'W'>& tool_tip, const Vec<'W'>& pointing, double tool);

// The joints of a hand at that place, and its wrist, without noise.
[[nodiscard]] HandSample skeleton(const Pose<'W', 'L'>& X_WL, const HandPlace& place, double skin);

class HandPlant {
 public:
  struct Frame {
    Measurement<HandSample> sample;
    Time due{};
    bool waiting = false;
  };
  struct State {
    Stream noise;
    DueTimes exposure;
    std::array<Frame, 64> on_wire;
    Measurement<HandSample> arrived;
    bool news = false;
  };
  HandPlant(const HandTrackerTruth& truth, const Pose<'W', 'L'>& X_WL, std::uint64_t seed);

  [[nodiscard]] const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }
  void advance(Time t, const HandPlace& place);  // once a tick
  bool poll(Measurement<HandSample>& newest) noexcept;

 private:
  void expose(Time t, const HandPlace& place);

  HandTrackerTruth truth_;
  Pose<'W', 'L'> X_WL_;
  State state_;
};

}  // namespace enc::sim
