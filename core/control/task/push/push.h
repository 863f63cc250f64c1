// Dynamic objects: an arm renders objects that the finger moves (hit, shift) and surfaces that run under it
// (spin) [VisHap 1, 2].
#pragma once

#include <array>
#include <vector>

#include "core/control/task/meet/meet.h"
#include "core/control/world/moving.h"

namespace enc {

struct Pushing : Meeting {
  std::array<Moved, kMostMoving> moved;
};

struct Push : Impedance {
  using Memory = Pushing;
  std::vector<Mover> movers;  // same order as Pushing::moved
};

template <class F>
void fields(F& f, Moved& m) {
  fields(f, "shift_W", m.shift);
  fields(f, "shift_velocity_W", m.velocity);
  f("moved_depth", m.depth);
  f("moved_deepest", m.deepest);
  f("moved_firmness", m.firmness);
}
template <class F>
void fields(F& f, Pushing& p) {
  fields(f, static_cast<Meeting&>(p));
  for (Moved& moved : p.moved) fields(f, moved);
}

namespace stages {
void track(Walk& walk, const Push& task, CommonState& state, Pushing& now) noexcept;
void act(Walk& walk, const Push& task, CommonState& state, Pushing& now) noexcept;
}  // namespace stages

}  // namespace enc
