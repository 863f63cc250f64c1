// Makes one device from a driver's module, or refuses it with one clear line.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/devices/driver.h"
#include "models/setup/driver_table.h"
#include "trial/assemble/assemble.h"

namespace enc::trial {

// An error of a device, with its role ("force") behind the place in the rig file that names its driver.
[[nodiscard]] inline Error of_role(const models::Setup& setup, const char* table, const Error& e) {
  const std::string place = models::place_of(setup, fmt::format("rig.{}.driver", table));
  return Error(fmt::format("{}: {}: {}", place, table, e.what()), {}, e.kind());
}

// `make` is the module's member for such a device, `name` is its name in messages ("force sensor"), `keeping`
// sets the timing of Offer. Throws Error (kind device; input if the module has no such device).
template <class Device>
std::unique_ptr<Device> driver_device(const std::string& driver, Maker<Device> DriverModule::*make,
                                      const char* name, const models::Setup& setup,
                                      const DriverSource& modules, Log& log, TimingMode keeping) {
  const ModuleInfo& module = modules(driver);
  if (module.driver == nullptr || module.driver->*make == nullptr)
    throw Error(fmt::format("module '{}' drives no {}; choose another driver in the rig file", driver, name));
  if (keeping.lockstep && !module.driver->lockstep && !module.driver->plays)
    throw Error(fmt::format("module '{}' cannot keep step with a fake; leave out --lockstep", driver), {},
                ErrorKind::device);
  models::DriverTableReader table(setup, driver);
  const Reach reach = reach_of(setup.rig);
  const std::vector<std::string> tools = tool_names(setup);
  auto device = (module.driver->*make)({table, setup.rig, reach, from_seconds(1.0 / setup.rig.loop.rate), log,
                                        keeping.waits, keeping.lockstep, tools});
  if (!device)
    throw Error(fmt::format("module '{}' made no {}; mend the driver", driver, name), {}, ErrorKind::device);
  return device;
}

}  // namespace enc::trial
