// All tasks. A task is a folder beside this file and a line of the list below. The folder has the task's
// data, its state (Memory) and its stages from track to report. Its part of a scene file is defined in
// core/spec.
#pragma once

#include <type_traits>
#include <variant>

#include "core/control/task/carry/travel.h"
#include "core/control/task/measure/probe.h"
#include "core/control/task/push/push.h"
#include "core/control/task/render/render.h"

namespace enc {

template <class... Task>
struct TaskList {
  using Any = std::variant<Task...>;
  // Before the first tick there is no state.
  using Memory = std::variant<std::monostate, typename Task::Memory...>;
};

using Tasks = TaskList<Render,  // admittance rendering: the tip gives way under a tool
                       Meet,    // impedance rendering: a prop meets a finger
                       Push,    // dynamic objects, which the finger moves
                       Probe,   // indentation test: presses and measures a real object
                       Travel   // tracking test: carries a tool past the tracker
                       >;

static_assert(std::is_trivially_copyable_v<Tasks::Memory>);

}  // namespace enc
