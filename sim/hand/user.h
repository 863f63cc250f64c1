// The operator model: the person who holds the tool. It plans a press, moves the arm (impedance and its own
// mass) and, through the grip, the tool. While pressing, the person closes a slow loop on depth (sources/hand
// 3). Tremor and drift add to the plan. [sources/hand 1, sources/hand 2] The presses are a list at one point,
// planned here, or random (session_plan.h).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/control/scene/scene.h"
#include "sim/hand/hand_plan.h"
#include "sim/hand/session_plan.h"
#include "sim/spec/twin_spec.h"
#include "sim/truth/random.h"
#include "sim/truth/truth.h"

namespace enc::sim {

// The tool that the scene's user holds first, index in the scene: the named one, else the first.
[[nodiscard]] std::int32_t held_tool(const SceneSpec& scene);

class User {
 public:
  struct State {
    Vec<'W'> hand_velocity = Vec<'W'>::zero();
    Point<'W'> hand;
    double integral = 0.0;     // m: addition of the depth loop to the intent
    double phase_start = 0.0;  // s
    std::int32_t press = 0;
    Phase phase = Phase::wait;
    bool touching = false;
    Stream noise;
    double tremor_phase[3] = {0, 0, 0};
    std::array<double, 12> band_rate{}, band_phase{};  // rad/s, rad: four sines for each axis
    std::int64_t drift_drawn = 0;                      // number of draws
    Vec<'W'> drift_from = Vec<'W'>::zero(),
             drift = Vec<'W'>::zero();  // last but one draw, and the last
    SessionPlan::State session;
    SteeredPlan steered;  // on: replaces the whole plan
    ToolChange change;    // steered hand only
  };

  // `prepared` must outlive it.
  User(const SceneSpec& scene, const Scene& prepared, const HandTruth& hand, std::uint64_t seed);

  [[nodiscard]] Point<'W'> start() const { return start_; }  // first position of the tool's tip
  [[nodiscard]] const State& state() const { return state_; }
  [[nodiscard]] std::int32_t press() const { return session_ ? state_.session.count : state_.press; }
  [[nodiscard]] std::int32_t object() const { return session_ ? state_.session.press.object : object_; }
  [[nodiscard]] Phase phase() const {
    return state_.steered.on ? Phase::wait : session_ ? state_.session.phase : state_.phase;
  }
  [[nodiscard]] bool aborted() const { return session_ && state_.session.press.aborted; }
  // The tool in the hand, index in the scene; -1: no tool. Then the tool that it may change to (-1: no tool),
  // and its resting place.
  [[nodiscard]] std::int32_t tool() const { return session_ ? session_->tool(state_.session) : tool_; }
  [[nodiscard]] std::int32_t other_tool() const { return session_ ? session_->other_tool() : -1; }
  [[nodiscard]] Point<'W'> spot(std::int32_t which) const { return session_->spot(which); }
  [[nodiscard]] bool turns() const { return session_.has_value(); }  // true if the tool turns
  // Unit, from the tool's tip to its markers: along the normal of the point; on the way there it turns to it.
  [[nodiscard]] Vec<'W'> shaft(double t) const {
    return session_ ? session_->shaft(t, state_.session) : press_.normal;
  }
  // The hand follows these positions from here on, and plans nothing by itself. `place`: of the tip's centre.
  void steer(const Point<'W'>& place, const Point<'W'>& tip);
  // Puts the held tool down and takes the other one. Does nothing in a scene with one tool, in contact, or
  // during a change.
  void change_tool(const Point<'W'>& tip);
  void restore(const State& state) { state_ = state; }
  [[nodiscard]] bool done() const;  // every press made, tool back and at rest; never for a steered hand
  [[nodiscard]] double approach_speed() const;
  [[nodiscard]] double duration() const;  // s, whole programme

  // Advances the plan and the arm by h; returns the force of the grip on the tool, N in W.
  Vec<'W'> act(double t, double h, const Point<'W'>& tool_tip, const Vec<'W'>& tool_velocity, bool touching);

 private:
  [[nodiscard]] double wanted_depth() const;  // this press, m
  [[nodiscard]] double phase_time(Phase phase) const;
  [[nodiscard]] HandPlan planned(double t);  // also starts the next phase
  [[nodiscard]] HandPlan plan(double since) const;
  [[nodiscard]] HandPlan approach(double since) const;
  void slide(double since, HandPlan& plan) const;
  [[nodiscard]] Vec3 tremor(double t, double h);
  void next_phase(double t);
  [[nodiscard]] Vec3 drift(double t);
  Vec3 unsteadiness(double t, double h);
  [[nodiscard]] Vec3 grip(const Point<'W'>& tool_tip, const Vec<'W'>& tool_velocity) const;
  void push_along(const Vec3& n, double since, Vec3& pulled) const;
  [[nodiscard]] Vec3 arm(const HandPlan& plan, const Vec3& intent) const;
  void move(double h, const Vec3& arm, const Vec3& grip);
  Vec<'W'> act_steered(double t, double h, const Point<'W'>& tool_tip, const Vec<'W'>& tool_velocity,
                       bool touching);
  void go_on_changing(double h);
  [[nodiscard]] Vec<'W'> normal_at(const Point<'W'>& tip) const;

  UserSpec spec_;
  const Scene& scene_;  // prepared
  HandTruth hand_;
  std::int32_t tool_;  // index in the scene
  PressPoint press_;
  Vec3 away_;         // unit, from the touched point to the start
  Point<'W'> touch_;  // tip centre at the touch
  Point<'W'> start_;
  std::int32_t object_;           // pressed object, index in the scene
  std::vector<double> expected_;  // N/m, of each object: the stiffness that the person has learned
  std::optional<SessionPlan> session_;
  State state_;
};

}  // namespace enc::sim
