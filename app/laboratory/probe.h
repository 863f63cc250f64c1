// Reads the devices of a rig without commanding them: how often samples come, how regularly and how late, and
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
  std::string role, words;  // as trial::DeviceWords has them
  bool there = true;
  std::int64_t samples = 0;       // news in that time
  double rate = kUnset;           // Hz
  Percentiles interval{}, age{};  // s: between the times that samples were true; of a sample when it came
  std::string last{};             // the last sample, in words
  std::vector<std::string> remarks{};  // as in the report of a run
  std::string unusable{};              // why a run could not use it; empty: it could
};

// Makes every device that is not simulated, reads each for so long at the loop's rate, and lets it go.
// Nothing is told: nothing moves. Where a machine does not answer, nothing is asked of the others: a run may
// have them all, and would lose them. `stop` is asked before each reading.
[[nodiscard]] std::vector<Probed> probe_devices(const models::Setup& setup,
                                                const trial::DriverSource& drivers, double seconds,
                                                const std::function<bool()>& stop);

}  // namespace enc::app
