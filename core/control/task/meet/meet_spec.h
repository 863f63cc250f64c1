// The fixed settings of the task that meets a finger by force: each with its unit, its meaning and how well
// it is known (published, derived or assumed). What a user may change stands in the rig file (arm_rig.h).
#pragma once

namespace enc {

// Where the prop shall be, and how it goes there (aim.cpp).
struct AimSpec {
  // Times leave_gap: a finger that is stopped seems to spring back by so much for a picture or two, and still
  // lies on the prop that it pushes (assumed: no finger was measured).
  static constexpr double kSpringsBack = 3.0;
  // m: a target on a curved surface is a little outside of it, and by no more than this (assumed: no source).
  static constexpr double kOutside = 0.5e-3;
  // m: the target is where the finger's projection is (assumed: some counts of an encoder, which are 0.03
  // mm).
  static constexpr double kThere = 0.2e-3;
  // m: a goal that is farther off is another object, or another part of it (assumed: no source).
  static constexpr double kLeap = 10e-3;
  // s: the target settles on a goal beside a prop whose surface runs (assumed: a belt is slower than pictures
  // leap).
  static constexpr double kBeltSettle = 0.060;
  // Share of the braking speed that the target takes (assumed: the rest is for a goal that moves).
  static constexpr double kBrakingShare = 0.9;
  // Ticks over which the speed of a struck prop is smoothed (assumed: one count of an encoder in a tick is 14
  // mm/s).
  static constexpr double kPropTicks = 8.0;
  // m: friction and a wrong weight hold the tip off its target by no more (assumed: friction of
  // 0.01 N m at each motor alone holds up to 4.5 mm at the tip).
  static constexpr double kFriction = 5e-3;
  // s: no rig file makes the arm slower than this in the check that it follows (assumed: no source).
  static constexpr double kLongestLag = 0.2;
  // m: a finger that is farther from the middle of the prop does not push it (assumed: no source).
  static constexpr double kBesideProp = 0.030;
  // s: the arm may be off its target for so long (assumed: no source).
  static constexpr double kPatience = 0.25;
};

// When the law lets friction hold the arm (control_law.cpp).
struct RestSpec {
  // m: an arm this close to its target may rest (derived: friction of 0.01 N m at each motor holds up to
  // 4.5 mm at the tip, and of twice as much 9).
  static constexpr double kNear = 10e-3;
  // m/s: the tip is no faster than encoders tell (derived: one count of two joints where the arm is
  // stretched).
  static constexpr double kCounts = 40e-3;
  // m/s: the filtered rate of the error has died out (assumed: no source; it takes 40 ms without a count).
  static constexpr double kStood = 1e-9;
  // m/s: the target does not move (assumed: no source).
  static constexpr double kTargetStill = 1e-3;
  // m: the tip has left the place where it came to rest (derived: five counts).
  static constexpr double kSlips = 0.15e-3;
  // m: all of the error has passed the filter (derived: one count).
  static constexpr double kArrived = 0.03e-3;
  // s: the push of an arm that rests fades to 1/e (assumed: no source).
  static constexpr double kFades = 0.05;
};

// Where a finger that comes will touch (coming.cpp, finger.h).
struct ComingSpec {
  // Times the vaguest noise: pictures stay clear enough up to this (assumed: a hysteresis of a tenth).
  static constexpr double kStaysClear = 1.1;
  // m: the tool waits so far above the foreseen touch (assumed: nothing is touched yet).
  static constexpr double kAbove = 1e-3;
  // N: a finger pushes the prop back (assumed: no source).
  static constexpr double kPushedBack = 0.2;
};

// Which samples are believed, how damping follows the mass, which side is touched (meet.cpp, arm_loop.cpp,
// tame.cpp).
struct MeetSpec {
  // m, m/s and rad: no arm of this kind is farther off, faster or turned farther (assumed: well beyond what
  // motors and links allow).
  static constexpr double kFarthest = 10.0, kFastest = 20.0, kMostTurned = 100.0;
  // Times the mass at home, up to which damping grows with the mass that is felt (assumed: no source; towards
  // the arm's base it grows by twice).
  static constexpr double kMostMassRatio = 4.0;
  // 1/kg: less is a direction in which the tip does not move (assumed: no source).
  static constexpr double kLeastMobility = 1e-6;
  // Cosine: the normal belongs to another side of the object (assumed: 26 degrees in one tick).
  static constexpr double kTurned = 0.9;
};

}  // namespace enc
