// What a person wants in two minutes with the ball [VHMR 4.4], or who reaches with a finger for what is there
// [VisHap 2.2]: hover over a place, reach for it in two submovements, press, hold, release, go on to the
// next; some reaches turn back, and once the tool is changed. All is drawn from one stream of the seed.
//
// Reach [Woodworth 1899; Meyer et al. 1988]: a primary submovement falls short of the surface or shoots over
// it, as its gain is drawn; where it falls short a second one goes on, aims a little beyond the surface and
// crosses it at the wanted speed. A reach that is given up has its primary movement taken back by an equal
// one, which begins before half of it is done [Henis and Flash 1995].
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/control/scene/scene.h"
#include "sim/hand/hand_plan.h"
#include "sim/hand/places.h"
#include "sim/spec/twin_spec.h"
#include "sim/truth/random.h"
#include "sim/truth/truth.h"

namespace enc::sim {

class SessionPlan {
 public:
  // One reach and the press after it, as drawn.
  struct Press {
    std::int32_t object = -1;  // index in the scene
    PressPoint at;
    Point<'W'> touch, start;      // of the tool tip's centre: where it touches, where the reach begins
    Submovement primary, second;  // the second corrects, or takes back
    bool aborted = false;
    double touch_speed = kUnset;              // m/s
    double reached = kUnset, depth = kUnset;  // m: at the end of the reach, and of the press
    double transit = 0.0, rest = 0.0;         // s: to the start, and there
    double reach_time = 0.0, press_time = 0.0, hold_time = 0.0, release_time = 0.0;  // s
  };
  struct State {
    Stream draws;
    Press press;
    Point<'W'> from;           // where the hand was before: of the tool tip's centre
    Vec<'W'> from_normal;      // and along what its tool pointed
    double phase_start = 0.0;  // s
    double change_at = kUnset;
    std::int32_t count = 0;  // of this press
    std::int32_t held = 0;   // 0: the tool it began with, 1: the other, -1: none
    bool changed = false, finished = false;
    Phase phase = Phase::wait;
  };

  SessionPlan(const SceneSpec& scene, const Scene& prepared, const HandTruth& hand);

  [[nodiscard]] State begin(std::uint64_t seed) const;
  void advance(double t, State& state) const;
  [[nodiscard]] HandPlan at(double t, const State& state) const;
  [[nodiscard]] Vec<'W'> shaft(double t,
                               const State& state) const;  // unit, from the tool's tip to its markers
  // Index in the scene of the held tool; -1: none.
  [[nodiscard]] std::int32_t tool(const State& state) const;
  [[nodiscard]] std::int32_t other_tool() const { return tools_[1]; }  // -1: there is none
  [[nodiscard]] Point<'W'> spot(
      std::int32_t which) const;  // where the tip of a tool lies: 0 the first, 1 the other
  [[nodiscard]] double duration(const State& begun) const;  // s

 private:
  [[nodiscard]] double phase_time(const State& state) const;
  void next(State& state) const;
  void next_press(State& state) const;
  void draw_press(State& state, std::int32_t which) const;
  void draw_start(Stream& draws, const Tool& tool, Press& press) const;
  void draw_reach(Stream& draws, Press& press) const;

  std::optional<SessionSpec> session_;  // one of these two
  std::optional<ReachesSpec> reaches_;
  ReachRanges ranges_;
  HandTruth hand_;
  const Scene& scene_;  // prepared
  std::int32_t tools_[2] = {-1, -1};
  Places places_;
};

}  // namespace enc::sim
