// The intent of a hand at a time, and the elements of its reaches: minimum-jerk submovements, which overlap
// and add up [Flash and Henis 1991; Milner 1992].
#pragma once

#include "core/base/frames.h"
#include "core/control/track/minimum_jerk.h"

namespace enc::sim {

struct HandPlan {
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero(),
       acceleration = Vec3::Zero();  // motion of the tool's tip, in W
  double depth = 0.0;                // m, below the surface
  double load = 1.0;                 // share of the object's force that the person already pushes with
};

// A motion from rest to rest, by `way`.
struct Submovement {
  double start = 0.0, time = 1.0;  // s
  Vec<'W'> way = Vec<'W'>::zero();

  [[nodiscard]] double end() const { return start + time; }
  [[nodiscard]] double peak_speed() const { return 1.875 * way.norm() / time; }
  void add_to(HandPlan& plan, double t) const {
    const MinimumJerk m((t - start) / time);
    plan.position += m.x * way.e();
    plan.velocity += (m.v / time) * way.e();
    plan.acceleration += (m.a / (time * time)) * way.e();
  }
};

}  // namespace enc::sim
