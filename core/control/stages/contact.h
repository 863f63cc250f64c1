// The anchor of a contact: the touched object, the tool and the position.
#pragma once

#include <cstdint>

#include "core/base/fields.h"
#include "core/base/time.h"

namespace enc {

// [VHMR 3.4]
struct Contact {
  std::int32_t object = -1;
  std::int32_t tool = -1;  // tool that began the contact; -1: unknown
  Pose<'W', 'N'> X_WN;     // anchor frame, set by the first touch
  // True once the sensor measured a force with the tip under the tool; the anchor no longer moves then.
  bool anchored = false;
  // True before the first force, while the tip is still on its way to the anchor, lower than its tool.
  bool below = false;
  // The contact's own tool is out of view. This may stay true after the contact, because the tool may still
  // press; the core then learns no force zero until the tool is seen clear of the object.
  bool unseen = false;
  // N: the force that has stayed constant while the contact's own tool is unseen.
  float steady_force = 0.0F;
  Time loaded{};         // last tick with force; the start of time: never
  Time began{}, left{};  // start of the contact, and of the tip's return
  // Time for which the force has had no cause, s (force_is_drift in render/mode.cpp).
  double clear = 0.0;
};

template <class F>
void fields(F& f, Contact& c) {
  f("contact_object", c.object);
  f("contact_tool", c.tool);
  fields(f, "contact_X_WN", c.X_WN);
  f("anchored", c.anchored);
  // Hashed only when true, which is rare, so that earlier hashes hold.
  if (c.below) f("contact_below", c.below);
  f("loaded", c.loaded);
  f("contact_began", c.began);
  f("contact_left", c.left);
  f("contact_clear", c.clear);
  if (c.steady_force != 0.0F) f("contact_steady_force", c.steady_force);
  if (c.unseen) f("contact_unseen", c.unseen);
}

}  // namespace enc
