// Reads the devices of a rig without commanding them: rate, regularity and delay of their samples, and
// whether a run could use them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/run/percentiles.h"
#include "models/setup/scene_file.h"
#include "trial/assemble/assemble.h"

namespace enc::app {

struct Probed {
  std::string role, words;  // as in trial::DeviceWords
  bool there = true;
  std::int64_t samples = 0;            // number of new samples in that time
  double rate = kUnset;                // Hz
  Percentiles interval{}, age{};       // s: between samples, by their stamps; age of a sample at its arrival
  std::string last{};                  // the last sample, in words
  std::vector<std::string> remarks{};  // as in the report of a run
  // Reason why a run could not use it; empty: it could.
  std::string unusable{};
};

// Makes every real device, reads each for this time at the loop's rate, and releases it. Sends no command:
// nothing moves. If a machine does not answer, the other devices are not queried, because a run may hold them
// all and would lose them. `stop` is called before each reading.
[[nodiscard]] std::vector<Probed> probe_devices(const models::Setup& setup,
                                                const trial::DriverSource& drivers, double seconds,
                                                const std::function<bool()>& stop);

}  // namespace enc::app
