#include "hw_drivers/phantom/drive/settings.h"

#include <array>
#include <string_view>

#include "core/base/error.h"

namespace enc::phantom {

void PhantomSettings::declare(Settings& table) {
  declare_common(table);
  table.value({.name = "device",
               .meaning = "the device's name in the vendor's set-up; of the fake: its HOST:PORT; empty: the "
                          "default device"},
              device);
  table.value({.name = "hottest",
               .meaning = "share of the motors' temperature limit, by the vendor's model, that is an error",
               .low = 0.1,
               .high = 1},
              hottest);
  table.value({.name = "agree_mm",
               .meaning = "largest distance between the device's tip and that of [arm.machine] at its joints",
               .low = 0.01,
               .high = 100},
              agreement);
  static constexpr std::array<std::string_view, 2> kCalibrations{"check", "update"};
  table.value(
      {.name = "calibration",
       .meaning = "check: an arm that is not calibrated is refused; update: it is calibrated where it "
                  "stands",
       .words = kCalibrations},
      calibration);
  static constexpr std::array<std::string_view, 2> kVelocities{"device", "joints"};
  table.value(
      {.name = "velocity",
       .meaning = "source of the tip's velocity: the device, or joints over velocity_window_ms of [arm.loop]",
       .words = kVelocities},
      velocity);
  table.value({.name = "joint_signs",
               .meaning = "signs of the device's turret, thigh and shin angles against q1, q2 and q3",
               .source = "OpenHaptics API reference"},
              joint_signs);
  table.value({.name = "origin_mm",
               .meaning = "origin of the device's coordinates in R; empty: the tip with all joints at 0",
               .source = "sources/arm 5"},
              origin);
}

arm::Place PhantomSettings::fake_place() const {
  arm::Place place;
  if (arm::read_place(device.empty() ? kUsualPlace : device, place)) return place;
  throw Error("driver.phantom.device is '" + device +
              "'; expected HOST:PORT, where the fake listens, such as " + kUsualPlace);
}

}  // namespace enc::phantom
