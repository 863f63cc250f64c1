// The physical tennis ball under a spherical probe: the twin's rig presses it, and the response file is
// computed from it until a real ball has been measured. Formula and values: sources/ball 4 (fits a
// finite-strain solver to 1.1 % rms).
#pragma once

#include <array>
#include <vector>

#include "sim/spec/twin_spec.h"

namespace enc::sim {

// Set "S-nominal": a dead or vented ball, about 12 N at 6 mm. A regulation ball gives 45-52 N there
// (sources/ball 3). Confidence: R = reported in reviews or data sheets, S = fitted to the solver, A =
// assumed.
struct BallParameters {
  double outer_radius = 33.0e-3;    // [S] m; ITF 65.4-68.6 mm diameter, middle minus 0.5 mm
  double probe_radius = 10.0e-3;    // [R] m; VHMR 4.2, the formula holds for this radius only
  double wall = 3.5e-3;             // [R] m; rubber core, 3.3-3.7
  double felt = 3.0e-3;             // [R] m; uncompressed, 2.5-3.3
  double rubber_modulus = 2.60e6;   // [S] Pa; 1.9-3.4, set so that the peak at 4 mm/s is 12 N
  double pressure = 10e3;           // [S] Pa, gauge; 0-20, not identifiable beside the modulus
  double felt_modulus = 0.20e6;     // [S] Pa; 0.12-0.40
  double friction = 0.10;           // [A] -; Coulomb part of the force, 0.06-0.17; bounded by the ITF loop
  double friction_travel = 0.6e-3;  // [A] m; travel over which it reverses
  std::array<double, 3> relaxing{0.06, 0.05, 0.05};  // [A] -; share of each rubber branch
  std::array<double, 3> relaxation{0.05, 0.5, 5.0};  // [A] s; its time constant
};

// The parameters of a set.
[[nodiscard]] BallParameters ball_set(BallSet set);

struct BallPlantState {
  double deflection = 0.0;           // m
  std::array<double, 3> relaxing{};  // N, force of each rubber branch
  double friction = 0.0;             // -1 ... 1, as a share of its full value; sign of the last long travel
};

class BallPlant {
 public:
  explicit BallPlant(const BallParameters& parameters = {});
  // The same elastic ball with the friction and relaxation of `loss`, whose other numbers are ignored. Avoids
  // computing the table again.
  [[nodiscard]] BallPlant with_loss(const BallParameters& loss) const;

  // Elastic force at rest, N; 0 below zero. Tabulated to 8 mm, and linear beyond (the formula is valid to 6
  // mm).
  [[nodiscard]] double elastic(double deflection) const;
  // Moves the ball from state.deflection to `deflection` (m, negative: no touch) in dt (s) at a constant
  // rate; returns the force, N.
  double step(BallPlantState& state, double deflection, double dt) const;

 private:
  BallParameters parameters_;
  std::vector<double> table_;  // N, elastic force every kStep
};

// Parameters of the ball: its set, overridden by single values. `radius`: of the object in the scene, m.
[[nodiscard]] BallParameters ball_of(const BallTruth& truth, double radius);

// A real ball under the probe of the indentation rig [VHMR Fig 7]: two spheres, with the ball's own law along
// the common normal and felt friction across it. The law is ours; MuJoCo only carries the force to the
// sensor.
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
