// All tasks. A task is a folder beside this file and a line of the list. The folder has what the task is made
// of, what it remembers (Memory), and its stages from track to report. Its part of a scene file stands in
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
  // Nothing is remembered before the first tick.
  using Memory = std::variant<std::monostate, typename Task::Memory...>;
};

using Tasks = TaskList<Render,  // by displacement: the tip gives way under a tool
                       Meet,    // by force: a prop meets a finger
                       Push,    // and at things that the finger moves
                       Probe,   // a real object is pressed and measured: nothing is rendered
                       Travel   // a tool is carried past the tracker: nothing is rendered
                       >;

static_assert(std::is_trivially_copyable_v<Tasks::Memory>);

}  // namespace enc
