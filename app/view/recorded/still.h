// A moment of a run by value, which the window shows now or later.
#pragma once

#include <vector>

#include "app/view/moment/moment.h"

namespace enc::app {

struct Still {
  sim::Truth truth;
  State state;
  Outputs out;
  Tick now;
  Pose<'R', 'H'> platform;
  Quat q_WT = Quat::Identity();
  bool halted = false;     // by hand
  bool simulated = true;   // every device: the truth has all touches
  std::vector<double> at;  // all geoms and sites of the model, in the order of mjData
};

// Takes the present moment of a trial with a twin. `simulated`: as in Still. If false, tool and tip are those
// reported by the devices, not the twin's.
void take_still(trial::Trial& trial, const trial::Glance& glance, bool simulated, Still& to);
// The moment for a picture; `data`, of the trial's model, receives the poses.
[[nodiscard]] Moment moment_of(trial::Trial& trial, const Still& still, mjData* data);

}  // namespace enc::app
