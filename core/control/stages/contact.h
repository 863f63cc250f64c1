// The anchor of a contact: which object is touched, by which tool, and where.
#pragma once

#include <cstdint>

#include "core/base/fields.h"
#include "core/base/time.h"

namespace enc {

// [VHMR 3.4]
struct Contact {
  std::int32_t object = -1;
  std::int32_t tool = -1;  // that began it; -1: none was known
  Pose<'W', 'N'> X_WN;     // at the first touch
  bool anchored = false;   // true once force was felt with the tip under the tool: the anchor no longer moves
  bool below = false;      // nothing was felt yet, and the tip is still on its way to it, lower than its tool
  // The contact's own tool is out of view. It may stay true after the contact: the tool may still press, and
  // no zero is learnt before it is seen clear.
  bool unseen = false;
  float steady_force = 0.0F;  // N: the force that has stayed the same while the contact's own tool is unseen
  Time loaded{};              // last tick on which force was felt; the start of time: never
  Time began{}, left{};       // when it began, and when the tip was sent back
  double clear = 0.0;         // s for which the force has had no cause (force_is_drift in render/mode.cpp)
};

template <class F>
void fields(F& f, Contact& c) {
  f("contact_object", c.object);
  f("contact_tool", c.tool);
  fields(f, "contact_X_WN", c.X_WN);
  f("anchored", c.anchored);
  if (c.below) f("contact_below", c.below);  // mostly it is not, and a hash is what it was
  f("loaded", c.loaded);
  f("contact_began", c.began);
  f("contact_left", c.left);
  f("contact_clear", c.clear);
  if (c.steady_force != 0.0F) f("contact_steady_force", c.steady_force);
  if (c.unseen) f("contact_unseen", c.unseen);
}

}  // namespace enc
