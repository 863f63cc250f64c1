// All tasks. A task is a folder beside this file and a line of the list below. The folder has the task's
// data, its state (Memory) and its stages from track to report. Its part of a scene file is defined in
// core/spec.
#pragma once

#include <span>
#include <type_traits>
#include <variant>

#include "core/control/stages/common_state.h"
#include "core/control/task/admittance/admittance_task.h"
#include "core/control/task/dynamic_object/dynamic_object.h"
#include "core/control/task/indentation/indentation.h"
#include "core/control/task/tracking/tracking.h"

namespace enc {

template <class... Task>
struct TaskList {
  using Any = std::variant<Task...>;
  // Before the first tick there is no state.
  using Memory = std::variant<std::monostate, typename Task::Memory...>;
};

using Tasks = TaskList<AdmittanceTask,     // admittance rendering: the tip gives way under a tool
                       ImpedanceTask,      // impedance rendering: a prop meets a finger
                       DynamicObjectTask,  // dynamic objects, which the finger moves
                       IndentationTask,    // indentation test: presses and measures a real object
                       TrackingTask        // tracking test: carries a tool past the tracker
                       >;

static_assert(std::is_trivially_copyable_v<Tasks::Memory>);

// The whole state of the core: the common part and the part of the scene's task.
struct State : CommonState {
  Tasks::Memory task;
};
static_assert(std::is_trivially_copyable_v<State>);

// State of the scene's task; a default one for another task or before the first tick.
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

// The present or last contact of a scene that renders a contact.
[[nodiscard]] inline const Contact& contact_of(const State& state) noexcept {
  const auto* rendering = std::get_if<AdmittanceState>(&state.task);
  return rendering != nullptr ? rendering->contact : recall<ImpedanceState>(state).contact;
}

// State of the objects that move, in the order of DynamicObjectTask::movers.
[[nodiscard]] inline std::span<const MoverState> moved_in(const State& state) noexcept {
  const auto* pushing = std::get_if<DynamicObjectState>(&state.task);
  return pushing != nullptr ? std::span<const MoverState>(pushing->moved) : std::span<const MoverState>();
}

// Bytes of State that a scene of this task uses.
template <class Task>
[[nodiscard]] constexpr std::size_t remembered() {
  return sizeof(State) - sizeof(Tasks::Memory) + sizeof(typename Task::Memory);
}

template <class F>
void fields(F&, std::monostate&) {}
template <class F>
void fields(F& f, State& s) {
  fields(f, static_cast<CommonState&>(s));
  std::visit([&f](auto& memory) { fields(f, memory); }, s.task);
}

}  // namespace enc
