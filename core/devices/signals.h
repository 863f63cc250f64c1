// What goes into a tick and what comes out of it.
#pragma once

#include <cstdint>

#include "core/base/sample.h"
#include "core/devices/mode.h"
#include "core/devices/view.h"

namespace enc {

// The newest sample of each device that exists; the others stay absent.
struct Inputs {
  Stamped<TrackedTool> tool;
  Stamped<Wrench> wrench;
  Stamped<TipSample> tip;
  Stamped<ArmSample> arm;
  Stamped<DentSample> dent;
  Stamped<GripSample> grip;
  std::int64_t missed = 0;  // cycles the clock lost before this tick
  bool withheld = false;    // what the machine is told is not sent: it need not follow
  bool resumed = false;     // of a machine whose link was lost: it may be anywhere, so it begins anew
};

struct Outputs {
  Pose<'R', 'H'> tip;  // set-point for the coming period
  Mode mode = Mode::away;
  std::uint32_t why = 0;      // bits of Why
  std::int32_t object = -1;   // nearest object, or the one in contact
  std::int32_t contacts = 0;  // contacts since the start
  double gap = kUnset;        // of the tracked tool's tip to the surface, m; negative inside
  Vec<'N'> force;             // on the tip, N, filtered; z along the outward normal
  Vec<'W'> felt;              // the same force before the low-pass, N
  double deflection = 0.0;    // along -z of N, m: wanted; of a probe: measured, negative before it touches
  Point<'W'> first_touch;     // buffered point of the current or last contact, tip centre
  View view;
  Grip grip;
  // Of an arm [VisHap 2.3]: force that it is told, gravity included; where its tip shall be; gain along the
  // normal. `force` and `felt` are then -Lambda f: what the finger feels, without gravity.
  Vec<'R'> arm_force;
  Point<'W'> wanted;
  double gain = kUnset;
  double prop_speed = 0.0;  // of a driven prop's surface against the prop, m/s
  Vec<'R'> prop_facing;     // that a prop's front shall face, unit; unset: as it does
};

}  // namespace enc
