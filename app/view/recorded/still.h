// A moment of a run by value, as the window shows it now or later.
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
  bool simulated = true;   // every device: the truth knows what is touched
  std::vector<double> at;  // of all geoms and sites of the model, as mjData has them
};

// The present moment of a trial with a twin. `simulated`: as in Still. Without it, tool and tip are where
// devices say, not where the twin has its own.
void take_still(trial::Trial& trial, const trial::Glance& glance, bool simulated, Still& to);
// For a picture of it; `data`, of the trial's model, takes the poses.
[[nodiscard]] Moment moment_of(trial::Trial& trial, const Still& still, mjData* data);

}  // namespace enc::app
