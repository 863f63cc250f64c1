#include "core/control/step.h"

#include "core/control/stages/step_context.h"

namespace enc {
namespace {

// Each stage reads the results of the stages before it. A task without a stage of its own uses that of its
// machine.
template <class Task>
void run_stages(stages::StepContext& context, const Task& task, State& state, Outputs& out) noexcept {
  using Memory = typename Task::Memory;
  auto* found = std::get_if<Memory>(&state.task);
  if (found == nullptr) {
    if (!std::holds_alternative<std::monostate>(state.task)) state = State{};
    found = &state.task.template emplace<Memory>();
  }
  Memory& memory = *found;
  if (context.in.missed >= context.scene.loop.late_cycles) context.why |= kClockLate;
  track(context, task, state, memory);  // poses of tool and tip
  touch(context, task, state, memory);  // nearest surface point and its gap
  act(context, task, state, memory);    // the task's reaction
  guard(context, task, state, memory);  // limited command to the machine
  report(context, task, state, memory, out);
  state.held = stages::holding(context);
}

void run_stages(stages::StepContext& context, const Scene& scene, State& state, Outputs& out) noexcept {
  std::visit([&](const auto& task) { run_stages(context, task, state, out); }, scene.task);
}

}  // namespace

void step(const Scene& scene, const Tick& tick, const Inputs& in, State& state, Outputs& out) noexcept {
  stages::StepContext context(scene, tick, in);
  run_stages(context, scene, state, out);
}

void guide(const Scene& scene, const Tick& tick, const Inputs& in, const Point<'W'>& to, State& state,
           Outputs& out) noexcept {
  stages::StepContext context(scene, tick, in);
  context.sent = to;
  run_stages(context, scene, state, out);
}

void carry(const Scene& scene, const Tick& tick, const Inputs& in, const Pose<'W', 'H'>& to, State& state,
           Outputs& out) noexcept {
  stages::StepContext context(scene, tick, in);
  context.carried = &to;
  run_stages(context, scene, state, out);
}

}  // namespace enc
