// The plan of a person for two minutes with the ball [VHMR 4.4], or of a finger that reaches for objects
// [VisHap 2.2]: hover over a point, reach for it in two submovements, press, hold, release, go on to the
// next. Some reaches turn back, and once the tool is changed. All numbers come from one stream of the seed.
//
// Reach [Woodworth 1899; Meyer et al. 1988]: a primary submovement falls short of the surface or overshoots
// it, by its random gain. If it falls short, a second one follows, aims a little beyond the surface and
// crosses it at the wanted speed. In an aborted reach an equal, opposite submovement takes the primary one
// back, and begins before half of it is done [Henis and Flash 1995].
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/control/scene/scene.h"
#include "sim/hand/hand_plan.h"
#include "sim/spec/twin_spec.h"
#include "sim/truth/random.h"
#include "sim/truth/truth.h"

namespace enc::sim {

struct Place {
  std::int32_t object = -1;  // index in the scene
  PressPoint at;
};

// The parts of a person's behaviour that differ from machine to machine.
struct HandAtMachine {
  // The stiffness that the person has learned to expect of an object, N/m.
  double (*expected)(const Object& object);
  bool (*pressable)(const Scene& scene, const Place& place, const Tool& tool);
};
[[nodiscard]] const HandAtMachine& hand_at(const SceneSpec& scene);

// Points that a person may reach for: uniform over the ball of a session, except where the machine cannot
// press [VHMR 4.4], or over the objects to which an arm carries its prop [VisHap 2.2].
class Places {
 public:
  // `prepared` must outlive it.
  Places(const SceneSpec& scene, const Scene& prepared);

  [[nodiscard]] Place draw(Stream& draws, const Tool& tool) const;
  // Distance from the tool's tip to the nearest object, m.
  [[nodiscard]] double gap(const Point<'W'>& tip, const Tool& tool) const;

 private:
  [[nodiscard]] PressPoint on(const Object& object, Stream& draws) const;

  const HandAtMachine& hand_;
  const Scene& scene_;
  bool everywhere_;         // true: all objects
  std::int32_t ball_;       // otherwise this object
  double lowest_, spread_;  // cosine of the largest polar angle; m
};

class SessionPlan {
 public:
  // One reach and the press after it, as drawn.
  struct Press {
    std::int32_t object = -1;  // index in the scene
    PressPoint at;
    // Tool tip's centre at the touch, and at the start of the reach.
    Point<'W'> touch, start;
    Submovement primary, second;  // the second corrects or takes back
    bool aborted = false;
    double touch_speed = kUnset;  // m/s
    // m: at the end of the reach, and of the press.
    double reached = kUnset, depth = kUnset;
    double transit = 0.0, rest = 0.0;  // s: to the start, and there
    double reach_time = 0.0, press_time = 0.0, hold_time = 0.0, release_time = 0.0;  // s
  };
  struct State {
    Stream draws;
    Press press;
    Point<'W'> from;           // tool tip's centre before this press
    Vec<'W'> from_normal;      // direction of the tool before this press
    double phase_start = 0.0;  // s
    double change_at = kUnset;
    std::int32_t count = 0;  // number of this press
    std::int32_t held = 0;   // 0: the first tool, 1: the other, -1: no tool
    bool changed = false, finished = false;
    Phase phase = Phase::wait;
  };

  SessionPlan(const SceneSpec& scene, const Scene& prepared, const HandTruth& hand);

  [[nodiscard]] State begin(std::uint64_t seed) const;
  void advance(double t, State& state) const;
  [[nodiscard]] HandPlan at(double t, const State& state) const;
  [[nodiscard]] Vec<'W'> shaft(double t,
                               const State& state) const;  // unit, from the tool's tip to its markers
  // Index in the scene of the held tool; -1: no tool.
  [[nodiscard]] std::int32_t tool(const State& state) const;
  [[nodiscard]] std::int32_t other_tool() const { return tools_[1]; }  // -1: no other tool
  // Resting place of a tool's tip: 0 the first, 1 the other.
  [[nodiscard]] Point<'W'> spot(std::int32_t which) const;
  [[nodiscard]] double duration(const State& begun) const;  // s

 private:
  [[nodiscard]] double phase_time(const State& state) const;
  void next(State& state) const;
  void next_press(State& state) const;
  void draw_press(State& state, std::int32_t which) const;
  void draw_start(Stream& draws, const Tool& tool, Press& press) const;
  void draw_reach(Stream& draws, Press& press) const;

  std::optional<SessionSpec> session_;  // one of these two is set
  std::optional<ReachesSpec> reaches_;
  ReachRanges ranges_;
  HandTruth hand_;
  const Scene& scene_;  // prepared
  std::int32_t tools_[2] = {-1, -1};
  Places places_;
};

}  // namespace enc::sim
