// State of an arm's passivity controller (control_law.cpp).
#pragma once

#include <cstdint>

#include "core/base/fields.h"
#include "core/control/safety/passivity/passivity.h"

namespace enc {

// The energy that the push along the normal has given out in this contact; unused without a passivity
// controller.
struct PassivityControl {
  Passivity energy;
  // J: energy left by a contact that was lost while the tip was inside.
  double kept = 0.0;
  std::int32_t object = -1;
  bool pressed = false;    // a finger pressed the prop and has not left it
  Point<'W'> tip, target;  // values of the last tick
  Vec<'W'> normal;
};

template <class F>
void fields(F& f, PassivityControl& t) {
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
