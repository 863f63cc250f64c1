// What the stages of an arm ask of the object under the finger. Internal to the core.
#pragma once

#include "core/task/walk.h"

namespace enc::stages {

// Null: there is none.
[[nodiscard]] inline const Object* nearest_object(const Walk& walk, const State& state) {
  return state.object < 0 ? nullptr : &walk.scene.objects[static_cast<std::size_t>(state.object)];
}

// The ball under a finger that has struck it.
[[nodiscard]] inline const Moved* hit_now(const Walk& walk, const State& state) {
  const Object* object = nearest_object(walk, state);
  const bool hit = object != nullptr && object->interaction.kind == Interaction::hit;
  if (!hit || state.mode != Mode::contact) return nullptr;
  return &walk.moved[static_cast<std::size_t>(object->moving)];
}

}  // namespace enc::stages
