// The person who holds the tool: plans a press, moves the arm (impedance and its own mass) and, through the
// grip, the tool. While pressing, the person closes a slow loop on depth (decisions 6). Tremor and drift ride
// on the plan. [parameters 5]
#pragma once

#include <cstdint>

#include "core/scene.h"
#include "sim/random.h"
#include "sim/truth.h"
#include "sim/twin_spec.h"

namespace enc::sim {

class User {
 public:
  struct State {
    Vec<'W'> hand_velocity = Vec<'W'>::zero();
    Point<'W'> hand;
    double integral = 0.0;     // m: what the depth loop adds to the intent
    double phase_start = 0.0;  // s
    std::int32_t press = 0;
    Phase phase = Phase::wait;
    bool touching = false;
    Stream noise;
    double tremor_phase[3] = {0, 0, 0};
    Vec<'W'> drift = Vec<'W'>::zero();
  };

  User(const SceneSpec& scene, const UserSpec& spec, const HandTruth& hand, double tool_radius,
       std::uint64_t seed);

  [[nodiscard]] Point<'W'> start() const { return start_; }  // where the tool's tip begins
  [[nodiscard]] double tool_radius() const { return tool_radius_; }
  [[nodiscard]] const PressPoint& press_point() const { return press_; }
  [[nodiscard]] const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }
  [[nodiscard]] bool done() const;  // every press made, tool back and at rest
  [[nodiscard]] double approach_speed() const;
  [[nodiscard]] double duration() const;  // s, of the whole programme

  // Advances the plan and the arm by h; gives the force of the grip on the tool, N in W.
  Vec<'W'> act(double t, double h, const Point<'W'>& tool_tip, const Vec<'W'>& tool_velocity, bool touching);

 private:
  // Where the tool's tip should be at a time, and how it should move there.
  struct Plan {
    Vec3 position, velocity, acceleration;
    double depth = 0.0;  // m, below the surface
  };
  [[nodiscard]] double wanted_depth() const;  // of this press, m
  [[nodiscard]] double phase_time(Phase phase) const;
  [[nodiscard]] Plan plan(double since) const;
  [[nodiscard]] Plan approach(double since) const;
  void next_phase(double t);
  Vec3 unsteadiness(double h);

  UserSpec spec_;
  HandTruth hand_;
  double tool_radius_;
  PressPoint press_;
  Vec3 away_;         // unit, from the touched point to the start
  Point<'W'> touch_;  // tip centre when it touches
  Point<'W'> start_;
  State state_;
};

}  // namespace enc::sim
