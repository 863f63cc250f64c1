// The fixed settings of the task that strikes balls with a prop. What a user may change stands in the rig
// file (arm_rig.h) and in the table of interactions.
#pragma once

namespace enc {

// By what a ball knows that it is hit: each with its unit, its meaning and
// how well it is known. Behind and faster mean: than the arm's target.
struct StrikeSpec {
  // m: a finger that is seen late is somewhere in here (assumed: a picture of it is 50 ms old).
  static constexpr double kNear = 0.030;
  // m/s: the prop goes faster than noise lets it seem (derived: two counts of an encoder in 2 ms are 0.014).
  static constexpr double kSpeed = 0.025;
  // m: the prop was moved (derived: two counts).
  static constexpr double kMoved = 0.06e-3;
  // m: friction holds the prop off the surface by no more (assumed: no source).
  static constexpr double kFriction = 0.6e-3;
  // s: the arm has come to rest so long after it arrived (assumed: no source).
  static constexpr double kSettled = 0.100;
  // s: an arm that moves is behind its target by some of this (assumed: no source).
  static constexpr double kLate = 0.004;
  // Share of the target's speed by which the arm's may differ (assumed: no source).
  static constexpr double kUneven = 0.12;
  // N: less than this is lost in the arm's friction (assumed: no source).
  static constexpr double kFelt = 0.05;
  // s: a strike without force for so long is over (assumed: no source).
  static constexpr double kEmpty = 0.10;
  // m: a prop that comes back so far behind where it was struck was not pushed by a finger (assumed: three
  // counts).
  static constexpr double kBack = 0.1e-3;
};

}  // namespace enc
