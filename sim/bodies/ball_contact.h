// A real ball under the probe of the test rig [VHMR Fig 7]: two spheres; the ball's own law along the common
// normal, felt friction across it. The law is ours: MuJoCo only carries the force to the sensor.
#pragma once

#include "sim/bodies/ball_plant.h"
#include "sim/spec/twin_spec.h"

namespace enc::sim {

// What the ball is: its set, with what is given apart put over it. `radius`: of the object in the scene, m.
[[nodiscard]] BallParameters ball_of(const BallTruth& truth, double radius);

class BallContact {
 public:
  struct State {
    BallPlantState ball;
    Vec<'W'> stretch = Vec<'W'>::zero();  // of felt and core along the surface; 1 where it slides
    Point<'W'> probe;                     // centre, one step ago; not set: was free
    double penetration = 0.0;             // m, along the normal; negative: the gap
    Vec<'W'> force = Vec<'W'>::zero();    // on the probe, N
    Point<'W'> touched;                   // where that force acts
  };
  // Confined: the ball's centre stays where it is. Throws Error for a probe that the ball's law does not hold
  // for.
  BallContact(const BallTruth& truth, const Point<'W'>& centre, double radius, double probe_radius);

  [[nodiscard]] const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }
  // The probe's centre goes straight to `probe` in dt, s.
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
