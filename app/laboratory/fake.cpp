// The devices of a rig that is not at hand: their wires, answered by the twin.
#include <cstdio>

#include <fmt/format.h>

#include "app/laboratory/fakes.h"
#include "app/laboratory/laboratory.h"
#include "app/modules/modules.h"
#include "app/process.h"
#include "app/run/stop_signals.h"
#include "core/error.h"

namespace enc::app {

int fake(const LaboratoryOptions& options) {
  const StopSignals signals;
  Fakes fakes(load_setup(with_scene(options)), {load_module, options.seed, options.lockstep});
  for (const std::string& line : fakes.describe()) fmt::print("{}\n", line);
  fmt::print("{}; ends with SIGINT or SIGTERM\n", options.lockstep
                                                      ? "time goes on by a period with each set-point"
                                                      : "time goes on with the wall clock");
  std::fflush(stdout);  // whoever began us waits for it
  check_output();
  while (StopSignals::caught() == 0) fakes.turn();
  for (const std::string& line : fakes.log()) fmt::print("{}\n", line);
  return 128 + StopSignals::caught();
}

}  // namespace enc::app
