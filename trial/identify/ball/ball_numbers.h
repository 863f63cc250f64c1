// The numbers of the ball's law (sim/bodies/ball_plant.h) as unknowns of a fit, with names as in
// [truth.ball].
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "sim/bodies/ball_plant.h"

namespace enc::trial {

// The ball and its position in the rig.
struct StandingBall {
  sim::BallParameters law;
  // m: the ball is this much nearer to the probe than the deflection says, as if misplaced along the push.
  double nearer = 0.0;
};

// First the numbers that a loop of force and deflection determines, then those that are held unless freed.
inline constexpr std::size_t kRubberModulus = 0, kPressure = 1, kFeltModulus = 2, kFriction = 3,
                             kFrictionTravel = 4, kRelaxingFast = 5, kRelaxingMiddle = 6, kRelaxingSlow = 7,
                             kNearer = 8, kLoopNumbers = 9;
inline constexpr std::size_t kWall = 9, kFelt = 10, kRelaxationFast = 11, kRelaxationMiddle = 12,
                             kRelaxationSlow = 13, kBallNumbers = 14;

struct BallNumber {
  std::string_view name;  // includes its unit; follows "truth.ball.", except for nearer_mm
  double unit;            // SI value of 1
  double scale;           // SI, a usual value: the unit of the fit's steps
  bool elastic;           // changes the elastic force
  bool positive;          // 0 or less is not a ball
  double& (*of)(StandingBall&);
  std::string_view remedy;  // remedy if the loops do not determine it
};
[[nodiscard]] std::span<const BallNumber> ball_numbers();

[[nodiscard]] inline double value_of(const BallNumber& number, StandingBall ball) { return number.of(ball); }

}  // namespace enc::trial
