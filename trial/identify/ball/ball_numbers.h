// The numbers of the ball's law (sim/bodies/ball_plant.h) as unknowns of a fit: names as in [truth.ball].
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "sim/bodies/ball_plant.h"

namespace enc::trial {

// The ball and how it stands in the rig.
struct StandingBall {
  sim::BallParameters law;
  double nearer = 0.0;  // m, to the probe than the deflection says; as if misplaced by that along the push
};

// First those that a loop of force and deflection tells, then those that are held unless freed.
inline constexpr std::size_t kRubberModulus = 0, kPressure = 1, kFeltModulus = 2, kFriction = 3,
                             kFrictionTravel = 4, kRelaxingFast = 5, kRelaxingMiddle = 6, kRelaxingSlow = 7,
                             kNearer = 8, kLoopNumbers = 9;
inline constexpr std::size_t kWall = 9, kFelt = 10, kRelaxationFast = 11, kRelaxationMiddle = 12,
                             kRelaxationSlow = 13, kBallNumbers = 14;

struct BallNumber {
  std::string_view name;  // with its unit; after "truth.ball." but for nearer_mm
  double unit;            // SI of 1
  double scale;           // SI, a usual value: steps of the fit are counted in it
  bool elastic;           // changes the elastic force
  bool positive;          // 0 or less is no ball
  double& (*of)(StandingBall&);
  std::string_view remedy;  // where the loops do not tell it
};
[[nodiscard]] std::span<const BallNumber> ball_numbers();

[[nodiscard]] inline double value_of(const BallNumber& number, StandingBall ball) { return number.of(ball); }

}  // namespace enc::trial
