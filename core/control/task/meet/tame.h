// The passivity controller of an arm, along the normal of the touched object: it acts between the law and the
// machine's limits. Internal to the core.
//
// It observes the tip relative to the law's target, along the mean normal of two ticks. So the motion of a
// target neither adds nor takes energy: an object may carry the target, or it follows its path or runs over a
// round object. The same holds for a normal that turns under a sliding tip.
#pragma once

#include "core/control/stages/walk.h"
#include "core/control/task/meet/meet.h"

namespace enc::stages {

struct Tame {
  // Limits the force that the law asks for.
  Tame(Walk& walk, const Impedance& law, const CommonState& state, Meeting& memory) noexcept;
  // Stores the push after all limits.
  void held(const Walk& walk, Meeting& memory, const Vec3& pushed) const noexcept;
  Vec3 wanted;
  double taken = 0.0;  // N, outward force taken from the law's
};

}  // namespace enc::stages
