// The devices of a rig: in place of those that are not there, or asked whether they are.
#pragma once

#include "app/common/options.h"

namespace enc::app {

struct LaboratoryOptions : SceneOptions {
  bool lockstep = false;            // of fake
  double seconds = 1.0;             // of devices
  std::vector<std::string> faults;  // of fake
};
int fake(const LaboratoryOptions& options);
int devices(const LaboratoryOptions& options);

}  // namespace enc::app
