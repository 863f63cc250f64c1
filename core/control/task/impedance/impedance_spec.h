// The fixed settings of impedance rendering: each with its unit, its meaning and its confidence (published,
// derived or assumed). User settings are in the rig file (rendering_rig.h).
#pragma once

namespace enc {

// Position of the prop and its path there (aim.cpp).
struct AimSpec {
  // Factor on leave_gap: in one or two pictures a stopped finger seems to spring back by this much, and still
  // rests on the prop that it pushes (assumed: no finger was measured).
  static constexpr double kSpringsBack = 3.0;
  // m: a target on a curved surface is outside of it by at most this (assumed: no source).
  static constexpr double kOutside = 0.5e-3;
  // m: the target counts as being at the finger's projection (assumed: some counts of an encoder, which are
  // 0.03 mm).
  static constexpr double kThere = 0.2e-3;
  // m: a goal that is farther off is another object, or another part of this one (assumed: no source).
  static constexpr double kLeap = 10e-3;
  // s: settling time of the target on a goal beside a prop whose surface runs (assumed: a belt is slower than
  // pictures jump).
  static constexpr double kBeltSettle = 0.060;
  // Share of the braking speed that the target uses (assumed: the rest is for a goal that moves).
  static constexpr double kBrakingShare = 0.9;
  // Ticks over which the speed of a struck prop is smoothed (assumed: one count of an encoder in a tick is 14
  // mm/s).
  static constexpr double kPropTicks = 8.0;
  // m: largest offset of the tip from its target by friction and a wrong weight (assumed: friction of 0.01 N
  // m at each motor alone holds up to 4.5 mm at the tip).
  static constexpr double kFriction = 5e-3;
  // s: longest lag of the arm that the following check accepts from a rig file (assumed: no source).
  static constexpr double kLongestLag = 0.2;
  // m: a finger that is farther from the middle of the prop does not push it (assumed: no source).
  static constexpr double kBesideProp = 0.030;
  // s: longest time for which the arm may be off its target (assumed: no source).
  static constexpr double kPatience = 0.25;
  // s: longest time for which an object's stiffness acts on a pushed prop after a picture has ended the
  // contact (assumed: five pictures).
  static constexpr double kLetsGo = 0.25;
};

// Conditions under which the law lets friction hold the arm (control_law.cpp).
struct RestSpec {
  // m: an arm this close to its target may rest (derived: friction of 0.01 N m at each motor holds up to 4.5
  // mm at the tip, and twice that friction 9 mm).
  static constexpr double kNear = 10e-3;
  // m/s: speed of the tip below the encoders' resolution (derived: one count of two joints with the arm
  // stretched).
  static constexpr double kCounts = 40e-3;
  // m/s: the filtered rate of the error has died out (assumed: no source; it takes 40 ms without a count).
  static constexpr double kStood = 1e-9;
  // m/s: the target does not move (assumed: no source).
  static constexpr double kTargetStill = 1e-3;
  // m: the tip has left its resting position (derived: five counts).
  static constexpr double kSlips = 0.15e-3;
  // m: the whole error has passed the filter (derived: one count).
  static constexpr double kArrived = 0.03e-3;
  // s: the push of a resting arm fades to 1/e (assumed: no source).
  static constexpr double kFades = 0.05;
};

// Predicted touch of an approaching finger (aim.cpp, finger.h).
struct ReachPredictionSpec {
  // Factor on the vaguest noise up to which pictures stay clear enough (assumed: a hysteresis of a tenth).
  static constexpr double kStaysClear = 1.1;
  // m: height of the waiting tool above the predicted touch (assumed: no contact yet).
  static constexpr double kAbove = 1e-3;
  // N: a finger pushes the prop back (assumed: no source).
  static constexpr double kPushedBack = 0.2;
};

// Valid samples, growth of damping with the mass, and the touched side (impedance_task.cpp, impedance.cpp,
// control_law.cpp).
struct MeetSpec {
  // m, m/s and rad: larger values of such an arm are invalid (assumed: well beyond the limits of motors and
  // links).
  static constexpr double kFarthest = 10.0, kFastest = 20.0, kMostTurned = 100.0;
  // Factor on the mass at home up to which damping grows with the effective mass (assumed: no source; towards
  // the arm's base it doubles).
  static constexpr double kMostMassRatio = 4.0;
  // 1/kg: below this the tip does not move in that direction (assumed: no source).
  static constexpr double kLeastMobility = 1e-6;
  // Cosine: the normal belongs to another side of the object (assumed: 26 degrees in one tick).
  static constexpr double kTurned = 0.9;
};

}  // namespace enc
