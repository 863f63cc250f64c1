// What an object does when a finger meets it: the entries of the interaction database that only an arm
// renders [VisHap 2.2]. A part of scene_spec.h.
#pragma once

#include <cstdint>

#include "core/base/frames.h"
#include "core/base/words.h"

namespace enc {

enum class Interaction : std::uint8_t {
  press,    // the response curve at the point first touched: what a hexapod renders
  slide,    // a wall: a spring along the normal, free along the surface [VisHap 2.3.3]
  click,    // a button: resistance, trigger, bottom
  passive,  // a real thing that stands there: the prop meets the finger, no virtual force is added
  hit,      // a free ball that is knocked away
  shift,    // a tile that slides along one way until its end
  spin      // a surface that runs away under the finger: a rotating drum
};
constexpr auto words(Interaction) {
  return enum_words("press", "slide", "click", "passive", "hit", "shift", "spin");
}

// What a prop is made to be felt as.
enum class PropKind : std::uint8_t { plate, key, drum };
constexpr auto words(PropKind) { return enum_words("plate", "key", "drum"); }

// Behind `stiffness` of the behaviour, which is what is felt first.
struct InteractionSpec {
  Interaction kind = Interaction::press;
  // click [VisHap Fig 4]: depth of the trigger d1 and of the bottom d2, m; stiffness between and beyond, N/m
  double trigger = 0.002, bottom = 0.004;
  double after = kUnset, floor = kUnset;
  double gradual = 0.5e-3;      // m of depth over which one stiffness becomes the next; 0: at once
  double gradual_time = 0.030;  // s, at least, for a whole change of it; 0: at once
  std::int32_t prop = -1;       // PropKind that feels right; -1: any
  // hit, shift
  double mass = 0.1;         // kg
  double restitution = 0.8;  // of a hit
  double friction = 0.1;     // N, that stops a tile; of a hit ball: nothing
  Vec3 way{1, 0, 0};         // unit, along which a tile slides, in O
  double travel = 0.030;     // m, to its end
  double speed = 0.050;      // of a spinning surface, m/s, along `way`
};

}  // namespace enc
