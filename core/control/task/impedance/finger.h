// Queries of an arm's stages: the object under the finger, and the place where the finger will touch it.
// Internal to the core.
#pragma once

#include "core/control/task/impedance/impedance_spec.h"
#include "core/control/task/impedance/impedance_task.h"

namespace enc::stages {

// Null if there is no object.
[[nodiscard]] inline const Object* nearest_object(const ArmContext& context, const CommonState& state) {
  return state.object < 0 ? nullptr : &context.scene.objects[static_cast<std::size_t>(state.object)];
}

// True if the user pushes the arm back. A finger that rests on a prop pushes, and moves as slowly as it
// presses or slides. A finger at the surface without a push is only a prediction, made before it slowed down.
[[nodiscard]] inline bool pushed_back(const CommonState& state, const Vec<'W'>& normal) {
  return -dot(state.force, normal) > ReachPredictionSpec::kPushedBack;
}
[[nodiscard]] inline bool presses(const CommonState& state, const Contact& contact) {
  return state.mode == Mode::contact && pushed_back(state, contact.X_WN * Vec<'N'>(0, 0, 1));
}

// The ball that the finger has struck; null if it struck no ball.
[[nodiscard]] inline const MoverState* hit_now(const ArmContext& context, const CommonState& state) {
  const Object* object = nearest_object(context, state);
  const bool hit = object != nullptr && object->interaction.kind == Interaction::hit;
  if (!hit || state.mode != Mode::contact) return nullptr;
  return &context.moved[static_cast<std::size_t>(object->moving)];
}

// Position of the target, and its motion from there.
struct Goal {
  Point<'W'> point;
  Vec<'W'> velocity = Vec<'W'>::zero();
  bool predicted = false;  // True if the point is a predicted touch.
};
// Predicted touch of an approaching finger; unset: no touch is predicted, or the finger lies on the prop.
[[nodiscard]] Goal predicted_touch(const ArmContext& context, const CommonState& state,
                                   ImpedanceState& now) noexcept;
// Point just above the predicted touch, by the last prediction; unset: no touch is predicted.
[[nodiscard]] Point<'W'> comes_to(const ArmContext& context, const ImpedanceState& now) noexcept;

}  // namespace enc::stages
