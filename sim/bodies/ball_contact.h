// A real ball under the probe of the indentation rig [VHMR Fig 7]: two spheres, with the ball's own law along
// the common normal and felt friction across it. The law is ours; MuJoCo only carries the force to the
// sensor.
#pragma once

#include "sim/bodies/ball_plant.h"
#include "sim/spec/twin_spec.h"

namespace enc::sim {

// Parameters of the ball: its set, overridden by single values. `radius`: of the object in the scene, m.
[[nodiscard]] BallParameters ball_of(const BallTruth& truth, double radius);

class BallContact {
 public:
  struct State {
    BallPlantState ball;
    Vec<'W'> stretch = Vec<'W'>::zero();  // felt and core along the surface; 1: sliding
    Point<'W'> probe;                     // centre, one step ago; unset: was free
    double penetration = 0.0;             // m, along the normal; negative: gap
    Vec<'W'> force = Vec<'W'>::zero();    // force on the probe, N
    Point<'W'> touched;                   // point of action of that force
  };
  // Confined: the ball's centre stays in place. Throws Error for a probe outside the validity of the ball's
  // law.
  BallContact(const BallTruth& truth, const Point<'W'>& centre, double radius, double probe_radius);

  [[nodiscard]] const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }
  // Moves the probe's centre straight to `probe` in dt, s.
  void move(const Point<'W'>& probe, double dt);

 private:
  [[nodiscard]] double evenness(const Vec3& normal) const;
  void drag(const Vec3& travel, const Vec3& normal);

  BallTruth truth_;
  Point<'W'> centre_;
  double radius_, probe_radius_;
  BallPlant plant_;
  State state_;
};

}  // namespace enc::sim
