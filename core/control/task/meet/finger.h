// What the stages of an arm ask of the object under the finger, and where the finger will touch it. Internal
// to the core.
#pragma once

#include "core/control/stages/walk.h"
#include "core/control/task/meet/meet.h"
#include "core/control/task/meet/meet_spec.h"

namespace enc::stages {

// Null: there is none.
[[nodiscard]] inline const Object* nearest_object(const Walk& walk, const CommonState& state) {
  return state.object < 0 ? nullptr : &walk.scene.objects[static_cast<std::size_t>(state.object)];
}

// A finger that rests on a prop moves as slowly as it presses or slides. It does when the arm is pushed back;
// that it has come to the surface is only what is foreseen, before it has slowed down.
[[nodiscard]] inline bool pushed_back(const CommonState& state, const Vec<'W'>& normal) {
  return -dot(state.force, normal) > ComingSpec::kPushedBack;
}
[[nodiscard]] inline bool presses(const CommonState& state, const Contact& contact) {
  return state.mode == Mode::contact && pushed_back(state, contact.X_WN * Vec<'N'>(0, 0, 1));
}

// The ball under a finger that has struck it.
[[nodiscard]] inline const Moved* hit_now(const Walk& walk, const CommonState& state) {
  const Object* object = nearest_object(walk, state);
  const bool hit = object != nullptr && object->interaction.kind == Interaction::hit;
  if (!hit || state.mode != Mode::contact) return nullptr;
  return &walk.moved[static_cast<std::size_t>(object->moving)];
}

// Where the target should be, and how it goes on from there.
struct Goal {
  Point<'W'> point;
  Vec<'W'> velocity = Vec<'W'>::zero();
  bool foreseen = false;  // where a reach will touch
};
// Where a finger that comes will touch; unset: as far as is known it does not, or it lies on the prop.
[[nodiscard]] Goal foreseen_touch(const Walk& walk, const CommonState& state, Meeting& now) noexcept;
// Just above that place, by what was last asked of it; unset: likewise.
[[nodiscard]] Point<'W'> comes_to(const Walk& walk, const Meeting& now) noexcept;

}  // namespace enc::stages
