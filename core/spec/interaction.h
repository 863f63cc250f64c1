// The response of an object to a finger: the entries of the interaction database that only an arm renders
// [VisHap 2.2]. A part of scene_spec.h.
#pragma once

#include <cstdint>

#include "core/base/frames.h"
#include "core/base/words.h"

namespace enc {

enum class Interaction : std::uint8_t {
  press,  // the response curve at the point of first touch; a hexapod renders this
  slide,  // a wall: a spring along the normal, free along the surface [VisHap 2.3.3]
  click,  // a button: resistance, trigger, bottom
  // A real object in its place: the prop meets the finger without virtual force.
  passive,
  hit,    // a free ball that is knocked away
  shift,  // a tile that slides along one direction to its end
  spin    // a surface that runs away under the finger: a rotating drum
};
constexpr auto words(Interaction) {
  return enum_words("press", "slide", "click", "passive", "hit", "shift", "spin");
}

// The object that a prop imitates.
enum class PropKind : std::uint8_t { plate, key, drum };
constexpr auto words(PropKind) { return enum_words("plate", "key", "drum"); }

// Details of the interaction beyond the behaviour's `stiffness`, which acts first.
struct InteractionSpec {
  Interaction kind = Interaction::press;
  // click [VisHap Fig 4]: depth of the trigger d1 and of the bottom d2, m; stiffness between and beyond, N/m
  double trigger = 0.002, bottom = 0.004;
  double after = kUnset, floor = kUnset;
  double gradual = 0.5e-3;      // m of depth over which one stiffness blends into the next; 0: at once
  double gradual_time = 0.030;  // s, shortest time of a whole blend; 0: at once
  std::int32_t prop = -1;       // suitable PropKind; -1: any
  // hit, shift
  double mass = 0.1;         // kg
  double restitution = 0.8;  // hit only
  double friction = 0.1;     // N, stops a tile; a hit ball has no friction
  Vec3 way{1, 0, 0};         // unit, direction in which a tile slides, in O
  double travel = 0.030;     // m, to the end of the path
  double speed = 0.050;      // spin: surface speed along `way`, m/s
};

}  // namespace enc
