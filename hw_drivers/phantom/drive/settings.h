// [driver.phantom] of a rig file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/spec/settings.h"
#include "hw_drivers/arm/common_settings.h"
#include "hw_drivers/arm/fake/message.h"

namespace enc::phantom {

struct PhantomSettings : arm::CommonSettings {
  std::string device;                 // empty: the default device
  double hottest = 0.95;              // share
  double agreement = 0.005;           // m
  std::string calibration = "check";  // or "update"
  std::string velocity = "device";    // or "joints"
  std::vector<double> joint_signs{-1, 1, 1};
  std::vector<double> origin;  // m, in R; empty: the tip with all joints at 0

  void declare(Settings& table);
  // The fake's place for this device: that of `device`, or the usual one. Throws Error if `device` is another
  // name.
  [[nodiscard]] arm::Place fake_place() const;
};

// End of the serial number of a fake whose time advances with each force.
inline constexpr std::string_view kInStep = " in lockstep";

// The place of a fake without a device's name; the variable ENCOUNTER_FAKE_HD of the environment replaces it.
inline constexpr const char* kUsualPlace = "127.0.0.1:18970";
inline constexpr const char* kPlaceVariable = "ENCOUNTER_FAKE_HD";

}  // namespace enc::phantom
