#include "hw_drivers/forcedimension/wire/dhd.h"

#include <fmt/format.h>

#include "hw_drivers/net/socket.h"

namespace enc::forcedimension::dhd {

Functions::Functions(const arm::Library& library) {
  library.find("dhdOpen", open);
  library.find("dhdOpenSerial", open_serial);
  library.find("dhdClose", close);
  library.find("dhdGetSystemName", system_name);
  library.find("dhdGetSerialNumber", serial_number);
  library.find("dhdGetSDKVersion", sdk_version);
  library.find("dhdGetStatus", status);
  library.find("dhdEnableForce", enable_force);
  library.find("dhdStop", stop);
  library.find("dhdEnableExpertMode", enable_expert);
  library.find("dhdDisableExpertMode", disable_expert);
  library.find("dhdSetWatchdog", set_watchdog);
  library.find("dhdSetMaxForce", set_max_force);
  library.find("dhdGetPosition", position);
  library.find("dhdGetLinearVelocity", velocity);
  library.find("dhdSetForce", set_force);
  library.find("dhdGetButtonMask", buttons);
  library.find("dhdErrorGetLast", last_error);
  library.find("dhdErrorGetLastStr", last_error_text);
}

std::string Functions::error_text() const {
  const char* const text = last_error_text();
  return net::printable(text != nullptr && *text != '\0' ? text : "no reason given");
}

std::string words_of(int error) {
  switch (error) {
    case kCommunication:
      return "DHD error 2: no communication; see cable and power";
    case kNoDevice:
      return "DHD error 5: no device; see cable and power";
    case kTimeout:
      return "DHD error 7: the device does not answer in time";
    case kDeviceInUse:
      return "DHD error 20: another program has the device; end that program";
    default:
      return fmt::format("DHD error {}", error);
  }
}

}  // namespace enc::forcedimension::dhd
