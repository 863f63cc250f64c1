// Dynamic objects: an arm renders objects that the finger moves (hit, shift) and surfaces that run under it
// (spin) [VisHap 1, 2].
#pragma once

#include <array>
#include <vector>

#include "core/control/task/impedance/impedance_task.h"
#include "core/control/world/moving.h"

namespace enc {

struct DynamicObjectState : ImpedanceState {
  std::array<MoverState, kMostMoving> moved;
};

struct DynamicObjectTask : Impedance {
  using Memory = DynamicObjectState;
  using Context = stages::ArmContext;
  std::vector<Mover> movers;  // same order as DynamicObjectState::moved
};

template <class F>
void fields(F& f, MoverState& m) {
  fields(f, "shift_W", m.shift);
  fields(f, "shift_velocity_W", m.velocity);
  f("moved_depth", m.depth);
  f("moved_deepest", m.deepest);
  f("moved_firmness", m.firmness);
}
template <class F>
void fields(F& f, DynamicObjectState& p) {
  fields(f, static_cast<ImpedanceState&>(p));
  for (MoverState& moved : p.moved) fields(f, moved);
}

namespace stages {
void track(ArmContext& context, const DynamicObjectTask& task, CommonState& state,
           DynamicObjectState& now) noexcept;
void act(ArmContext& context, const DynamicObjectTask& task, CommonState& state,
         DynamicObjectState& now) noexcept;
}  // namespace stages

}  // namespace enc
