// The fixed settings of the task with dynamic objects. User settings are in the rig file (arm_rig.h) and in
// the table of interactions.
#pragma once

namespace enc {

// Criteria for a struck ball: each with its unit, its meaning and its confidence. "Behind" and "faster" are
// relative to the arm's target.
struct StrikeSpec {
  // m: region of a finger that is tracked with delay (assumed: a picture of it is 50 ms old).
  static constexpr double kNear = 0.030;
  // m/s: the prop moves faster than noise can explain (derived: two counts of an encoder in 2 ms are 0.014).
  static constexpr double kSpeed = 0.025;
  // m: the prop was moved (derived: two counts).
  static constexpr double kMoved = 0.06e-3;
  // m: largest distance at which friction holds the prop off the surface (assumed: no source).
  static constexpr double kFriction = 0.6e-3;
  // s: time from the arm's arrival to its rest (assumed: no source).
  static constexpr double kSettled = 0.100;
  // s: lag of a moving arm behind its target (assumed: no source).
  static constexpr double kLate = 0.004;
  // Share of the target's speed by which the arm's may differ (assumed: no source).
  static constexpr double kUneven = 0.12;
  // N: a smaller force is lost in the arm's friction (assumed: no source).
  static constexpr double kFelt = 0.05;
  // s: a strike without force for this time is over (assumed: no source).
  static constexpr double kEmpty = 0.10;
  // m: a prop that returns to this distance behind its strike was not pushed by a finger (assumed: three
  // counts).
  static constexpr double kBack = 0.1e-3;
};

}  // namespace enc
