// Inputs and outputs of a tick.
#pragma once

#include <cstdint>

#include "core/base/frames.h"
#include "core/base/sample.h"
#include "core/base/time.h"
#include "core/devices/mode.h"

namespace enc {

// Data of a tick for the display: the tools' poses and the mode.
struct View {
  Time t{};
  std::int32_t tool = -1;    // index in the scene; -1: no tool seen
  std::int32_t object = -1;  // nearest object; -1: no object
  Pose<'W', 'T'> X_WT;       // the tool's markers, as tracked
  Point<'W'> tip;            // centre of the tool's tip
  Mode mode = Mode::away;
};

// The newest sample of each existing device; the others stay absent.
struct Inputs {
  Measurement<TrackedTool> tool;
  Measurement<Wrench> wrench;
  Measurement<TipSample> tip;
  Measurement<ArmSample> arm;
  Measurement<DentSample> dent;
  Measurement<GripSample> grip;
  std::int64_t missed = 0;  // cycles that the clock lost before this tick
  // Commands are not sent to the machine: do not check that it follows.
  bool withheld = false;
  // The machine's link was lost and is back: the core starts anew from the reported pose.
  bool resumed = false;
};

// Part of a machine that takes positions; unset for others.
struct ManipulatorOutputs {
  Pose<'R', 'H'> tip;  // set-point for the coming period
  Grip grip;           // command to its gripper
};

// Part of an arm [VisHap 2.3]; unset for other machines.
struct ArmOutputs {
  Vec<'R'> force;           // commanded tip force, N, including gravity compensation
  Point<'W'> target;        // commanded tip position
  double gain = kUnset;     // along the normal
  double prop_speed = 0.0;  // of a driven prop's surface relative to the prop, m/s
  Vec<'R'> prop_facing;     // commanded direction of a prop's front, unit; unset: keep it
};

struct Outputs {
  Mode mode = Mode::away;
  std::uint32_t why = 0;      // bits of Reason
  std::int32_t object = -1;   // nearest object, or the one in contact
  std::int32_t contacts = 0;  // contacts since the start
  double gap = kUnset;        // tracked tool's tip to the surface, m; negative inside
  // On the tip, N, filtered; z along the outward normal. An arm reports -Lambda f: the force on the finger,
  // without gravity.
  Vec<'N'> force;
  Vec<'W'> force_unfiltered;  // that force before the low-pass, N
  // Deflection along -z of N, m: commanded; for a probe: measured, negative before the first touch.
  double deflection = 0.0;
  Point<'W'> first_touch;  // Buffered point of the current or last contact, tip centre.
  View view;
  ManipulatorOutputs manipulator;
  ArmOutputs arm;
};

}  // namespace enc
