// All the memory that the core has: what every task needs, and what this one does.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <variant>

#include "core/base/sample.h"
#include "core/control/task/tasks.h"
#include "core/control/track/predict.h"
#include "core/devices/mode.h"

namespace enc {

// Which part of which object was nearest: makes the next search faster, and changes no result (surface.h).
struct ObjectHint {
  std::int32_t object = -1, feature = -1;
};
struct Hints {
  std::array<ObjectHint, 2> tool;  // nearest to the tool, and the runner-up
  ObjectHint tip;                  // nearest to the tip, and
  ObjectHint command;              // to where it is sent
};

struct State {
  bool started = false;
  Mode mode = Mode::away;  // the mode under a hold
  bool held = false;       // the last tick was one
  std::int32_t contacts = 0;
  std::int32_t object = -1;
  bool entered = false;  // the tip has been inside that object
  Stamped<TrackedTool> tool;
  TipMotion tip_motion;  // of the tracked tool
  Vec<'W'> force = Vec<'W'>::zero();
  Point<'W'> last_query, last_point;  // of the last tick: the tracked tool's tip and the surface under it
  Hints hints;
  Tasks::Memory task;
};
static_assert(std::is_trivially_copyable_v<State>);

// What the task of the scene remembers; of another task, or before the first tick, nothing yet.
template <class Memory>
[[nodiscard]] const Memory& recall(const State& state) noexcept {
  static const Memory kNothing{};
  const Memory* found = std::visit(
      [](const auto& memory) -> const Memory* {
        if constexpr (std::is_base_of_v<Memory, std::remove_cvref_t<decltype(memory)>>)
          return &memory;
        else
          return nullptr;
      },
      state.task);
  return found != nullptr ? *found : kNothing;
}

// The present or last contact of a scene in which something is felt.
[[nodiscard]] inline const Contact& contact_of(const State& state) noexcept {
  const auto* rendering = std::get_if<Rendering>(&state.task);
  return rendering != nullptr ? rendering->contact : recall<Meeting>(state).contact;
}

// How far the objects that move have got, in the order of Push::movers.
[[nodiscard]] inline std::span<const Moved> moved_in(const State& state) noexcept {
  const auto* pushing = std::get_if<Pushing>(&state.task);
  return pushing != nullptr ? std::span<const Moved>(pushing->moved) : std::span<const Moved>();
}

// Bytes that a scene of this task remembers, of State.
template <class Task>
[[nodiscard]] constexpr std::size_t remembered() {
  return sizeof(State) - sizeof(Tasks::Memory) + sizeof(typename Task::Memory);
}

template <class F>
void fields(F& f, std::string_view name, ObjectHint& h) {
  f(name, h.object);
  f(name, h.feature);
}
template <class F>
void fields(F& f, TipMotion& m) {
  f("motion_tool", m.tool);
  f("motion_t", m.t);
  fields(f, "motion_position_W", m.position);
  fields(f, "motion_velocity_W", m.velocity);
  fields(f, "motion_acceleration_W", m.acceleration);
  for (AxisDoubt* const d : {&m.along, &m.across})
    for (double* const x : {&d->xx, &d->xv, &d->xa, &d->vv, &d->va, &d->aa}) f("motion_covariance", *x);
}
template <class F>
void fields(F&, std::monostate&) {}
template <class F>
void fields(F& f, State& s) {
  f("started", s.started);
  f("state_mode", s.mode);
  f("held", s.held);
  f("state_contacts", s.contacts);
  f("state_object", s.object);
  f("entered", s.entered);
  fields(f, s.tool);
  fields(f, s.tip_motion);
  fields(f, "force_W", s.force);
  fields(f, "last_query_W", s.last_query);
  fields(f, "last_point_W", s.last_point);
  fields(f, "nearest_hint", s.hints.tool[0]);
  fields(f, "runner_up_hint", s.hints.tool[1]);
  fields(f, "tip_hint", s.hints.tip);
  fields(f, "command_hint", s.hints.command);
  std::visit([&f](auto& memory) { fields(f, memory); }, s.task);
}

}  // namespace enc
