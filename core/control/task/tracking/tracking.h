// The tracking test of [VHMR 4.1, Fig 6], prepared: straight legs from stop to stop, along one axis of W
// after another. Each leg is a trapezoid with the leg's speed and the machine's acceleration.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/frames.h"
#include "core/control/stages/displacement.h"
#include "core/spec/task_spec.h"

namespace enc {

struct Outputs;
struct CommonScene;
struct SceneSpec;

struct TravelLeg {
  Point<'W'> to;
  Vec<'W'> along{1, 0, 0};  // unit
  double length = 0.0;      // m
  double speed = kUnset;    // m/s
  double dwell = kUnset;    // s, at the leg's end
  std::int32_t axis = -1;   // 0 to 2; -1: a leg to a start
  std::int32_t way = 0;     // 1: towards + of the axis, -1: towards -
};

// Phase of the travel. The travel's time stands still in a hold.
enum class TravelPhase : std::uint8_t { wait, move, dwell, done };
struct TrackingState : CommandState {
  TravelPhase phase = TravelPhase::wait;
  double elapsed = 0.0;  // s of this phase
  std::int32_t leg = 0;  // index in TrackingTask::legs
};

namespace stages {
struct TrackingContext : ManipulatorContext {
  using ManipulatorContext::ManipulatorContext;
  // Set by carry(): commanded pose of the machine with its tool; null: the next stop.
  const Pose<'W', 'H'>* carry_target = nullptr;
};
}  // namespace stages

struct TrackingTask : DisplacementTask {
  using Memory = TrackingState;
  using Context = stages::TrackingContext;
  // The travel that the scene asks for, if any; `scene` is otherwise complete. Throws Error if this machine
  // cannot do the travel.
  [[nodiscard]] static std::optional<TrackingTask> asked(const SceneSpec& spec, const CommonScene& scene);

  std::vector<TravelLeg> legs;
  double acceleration = kUnset;  // m/s^2
  bool tool_held = false;        // the tool must be clamped before any motion

  [[nodiscard]] bool on_leg(std::int32_t leg) const {
    return leg >= 0 && static_cast<std::size_t>(leg) < legs.size();
  }
  // Upper bound of the time from the start to the end of the last dwell, s.
  [[nodiscard]] double duration() const;
};

template <class F>
void fields(F& f, TrackingState& t) {
  fields(f, static_cast<CommandState&>(t));
  f("travel_phase", t.phase);
  f("travel_elapsed", t.elapsed);
  f("travel_leg", t.leg);
}

namespace stages {
void touch(TrackingContext& context, const TrackingTask& task, CommonState& state,
           TrackingState& now) noexcept;
void act(TrackingContext& context, const TrackingTask& task, CommonState& state, TrackingState& now) noexcept;
void guard(TrackingContext& context, const TrackingTask& task, CommonState& state,
           TrackingState& now) noexcept;
void report(const TrackingContext& context, const TrackingTask& task, CommonState& state,
            const TrackingState& now, Outputs& out) noexcept;
}  // namespace stages

}  // namespace enc
