// The devices of a rig: fakes that replace missing ones, or a check whether they answer.
#pragma once

#include "app/common/options.h"

namespace enc::app {

struct LaboratoryOptions : SceneOptions {
  bool lockstep = false;            // `fake` only
  double seconds = 1.0;             // `devices` only
  std::vector<std::string> faults;  // `fake` only
};
int fake(const LaboratoryOptions& options);
int devices(const LaboratoryOptions& options);

}  // namespace enc::app
