// The time limits of a real rig, as settings. models/rigs/fakes.toml allows ten times as much, because on the
// wall clock fakes share the processor with the run; in virtual time and in lockstep no data are late.
#pragma once

#include <string>
#include <vector>

namespace enc::wires {

inline std::vector<std::string> tight_times(std::vector<std::string> more = {}) {
  std::vector<std::string> set{"rig.loop.late_cycles=5", "rig.force.stale_ms=5"};
  set.insert(set.end(), more.begin(), more.end());
  return set;
}

}  // namespace enc::wires
