#include "core/control/step.h"

#include "core/control/stages/walk.h"

namespace enc {
namespace {

// Each stage reads the results of the stages before it. A task without a stage of its own uses that of its
// machine.
template <class Task>
void walk_through(stages::Walk& walk, const Task& task, State& state, Outputs& out) noexcept {
  using Memory = typename Task::Memory;
  auto* found = std::get_if<Memory>(&state.task);
  if (found == nullptr) {
    if (!std::holds_alternative<std::monostate>(state.task)) state = State{};
    found = &state.task.template emplace<Memory>();
  }
  Memory& memory = *found;
  if (walk.in.missed >= walk.scene.loop.late_cycles) walk.why |= kClockLate;
  track(walk, task, state, memory);  // poses of tool and tip
  touch(walk, task, state, memory);  // nearest surface point and its gap
  act(walk, task, state, memory);    // the task's reaction
  guard(walk, task, state, memory);  // limited command to the machine
  report(walk, task, state, memory, out);
  state.held = stages::holding(walk);
}

void walk_through(stages::Walk& walk, const Scene& scene, State& state, Outputs& out) noexcept {
  std::visit([&](const auto& task) { walk_through(walk, task, state, out); }, scene.task);
}

}  // namespace

void step(const Scene& scene, const Tick& tick, const Inputs& in, State& state, Outputs& out) noexcept {
  stages::Walk walk(scene, tick, in);
  walk_through(walk, scene, state, out);
}

void guide(const Scene& scene, const Tick& tick, const Inputs& in, const Point<'W'>& to, State& state,
           Outputs& out) noexcept {
  stages::Walk walk(scene, tick, in);
  walk.sent = to;
  walk_through(walk, scene, state, out);
}

void carry(const Scene& scene, const Tick& tick, const Inputs& in, const Pose<'W', 'H'>& to, State& state,
           Outputs& out) noexcept {
  stages::Walk walk(scene, tick, in);
  walk.carried = &to;
  walk_through(walk, scene, state, out);
}

}  // namespace enc
