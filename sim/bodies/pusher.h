// A pusher outside of the machine, such as a hand or a stand: a spring and a damper towards a point that goes
// in, waits and comes back along a line. It can push, but not pull [sources/hand 5]:
//
//   F = max(0, k (x_s - x) + b (v_s - v) + tremor)      x: depth of the tip's outermost point below the
//   surface
//
// The law is ours; MuJoCo only carries the force to the sensor.
#pragma once

#include <cstdint>

#include "core/control/scene/scene.h"
#include "sim/spec/twin_spec.h"
#include "sim/truth/random.h"
#include "sim/truth/truth.h"

namespace enc::sim {

class Pusher {
 public:
  struct State {
    std::int32_t push = 0;      // the next or present one
    Phase phase = Phase::wait;  // then press, hold, release
    double phase_start = 0.0;   // s
    Stream noise;
    double tremor[2] = {0.0, 0.0};  // N, in phase and a quarter period behind
    double force = 0.0;             // N
  };

  Pusher(const PusherSpec& spec, const PusherTruth& truth, const PushedPoint& to, double tip_radius,
         std::uint64_t seed);

  [[nodiscard]] const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }
  [[nodiscard]] const Vec<'W'>& normal() const { return to_.at.normal; }  // outward: against the push
  [[nodiscard]] bool done() const { return state_.push >= spec_.repeats; }
  [[nodiscard]] double duration() const;  // s, whole programme
  // Depth at which the spring is at rest at the end of the ramp, m: the object's force then holds the tip at
  // the wanted depth.
  [[nodiscard]] double reach() const { return to_.depth + to_.force / truth_.stiffness; }
  // True if the step of h from t reaches the time `ahead` (s) before the next push.
  [[nodiscard]] bool near(double t, double h, double ahead) const;
  // Advances by h from t, s. Arguments: the tip's centre and velocity at the end of the step. Returns the
  // force on the tip, N.
  Vec<'W'> act(double t, double h, const Point<'W'>& tip, const Vec<'W'>& velocity);

 private:
  struct Intent {
    double x, v;  // m, m/s
  };
  [[nodiscard]] double phase_time() const;
  [[nodiscard]] Intent intent(double since) const;
  void next_phase(double t);
  double tremble(double h);

  PusherSpec spec_;
  PusherTruth truth_;
  PushedPoint to_;
  double tip_radius_;
  State state_;
};

}  // namespace enc::sim
