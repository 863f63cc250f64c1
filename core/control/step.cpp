#include "core/control/step.h"

namespace enc {
namespace {

// Each stage reads the results of the stages before it. A task without a stage of its own uses that of its
// machine.
template <class Task>
void run_stages(typename Task::Context& context, const Task& task, State& state, Outputs& out) noexcept {
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

// `prepare` puts a procedure's command into the context of the scene's task.
template <class Prepare>
void run_task(const Scene& scene, const Tick& tick, const Inputs& in, State& state, Outputs& out,
              const Prepare& prepare) noexcept {
  std::visit(
      [&](const auto& task) {
        typename std::remove_cvref_t<decltype(task)>::Context context(scene, tick, in);
        prepare(context);
        run_stages(context, task, state, out);
      },
      scene.task);
}

}  // namespace

void step(const Scene& scene, const Tick& tick, const Inputs& in, State& state, Outputs& out) noexcept {
  run_task(scene, tick, in, state, out, [](auto&) {});
}

void guide(const Scene& scene, const Tick& tick, const Inputs& in, const Point<'W'>& to, State& state,
           Outputs& out) noexcept {
  run_task(scene, tick, in, state, out, [&to](auto& context) {
    if constexpr (requires { context.guide_target; }) context.guide_target = to;
  });
}

void carry(const Scene& scene, const Tick& tick, const Inputs& in, const Pose<'W', 'H'>& to, State& state,
           Outputs& out) noexcept {
  run_task(scene, tick, in, state, out, [&to](auto& context) {
    if constexpr (requires { context.carry_target; }) context.carry_target = &to;
  });
}

}  // namespace enc
