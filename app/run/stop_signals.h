// A person or a system wants the program to end: then a run ends as its end does, with its report, its record
// sealed and its devices let go.
#pragma once

#include "app/run/signal_actions.h"

namespace enc::app {

// While one of these lives, SIGINT, SIGTERM and SIGHUP are only noted, and a pipe that nobody reads (SIGPIPE)
// is an error of that pipe. A second signal of a kind kills, as ever. What was ignored before (nohup) stays
// ignored.
class StopSignals {
 public:
  StopSignals();

  [[nodiscard]] static int caught() noexcept;  // number of the first one, 0: none

 private:
  SignalActions actions_;
};

}  // namespace enc::app
