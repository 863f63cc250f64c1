// The passivity controller of an arm, along the normal of what is touched: between its law and what the
// machine can. Internal to the core.
//
// It watches the tip against the law's target, along the mean of two ticks' normals: what a target does that
// moves goes neither in nor out, be it that it is carried by an object, on its way, or on a round one. Nor
// does a normal that turns under a tip that slides.
#pragma once

#include "core/control/stages/walk.h"
#include "core/control/task/meet/meet.h"

namespace enc::stages {

struct Tame {
  // What the law asks for, and what of that is given.
  Tame(Walk& walk, const Impedance& law, const CommonState& state, Meeting& memory) noexcept;
  // What was really pushed with, after all limits.
  void held(const Walk& walk, Meeting& memory, const Vec3& pushed) const noexcept;
  Vec3 wanted;
  double taken = 0.0;  // N, outwards
};

}  // namespace enc::stages
