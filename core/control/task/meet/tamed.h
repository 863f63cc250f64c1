// What the passivity controller of an arm remembers (tame.h).
#pragma once

#include <cstdint>

#include "core/base/fields.h"
#include "core/control/safety/passivity/passivity.h"

namespace enc {

// What the push along the normal has given out in the present contact; nothing where that is not controlled.
struct Tamed {
  Passivity energy;
  double kept = 0.0;  // J: was left of a contact that was lost while the tip was inside
  std::int32_t object = -1;
  bool pressed = false;    // its prop was met, and is not let go of
  Point<'W'> tip, target;  // at the last tick, and the normal
  Vec<'W'> normal;
};

template <class F>
void fields(F& f, Tamed& t) {
  if (!t.energy.on && t.kept == 0.0) return;
  fields(f, t.energy);
  f("passivity_kept", t.kept);
  f("passivity_object", t.object);
  f("passivity_pressed", t.pressed);
  fields(f, "passivity_tip_W", t.tip);
  fields(f, "passivity_target_W", t.target);
  fields(f, "passivity_normal_W", t.normal);
}

}  // namespace enc
