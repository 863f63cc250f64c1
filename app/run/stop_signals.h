// A person or a system wants the program to end: then a run ends as its end does, with its report, its record
// sealed and its devices let go.
#pragma once

namespace enc::app {

// While one of these lives, SIGINT, SIGTERM and SIGHUP are only noted, and a pipe that nobody reads (SIGPIPE)
// is an error of that pipe. A second signal of a kind kills, as ever. What was ignored before (nohup) stays
// ignored.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  [[nodiscard]] static int caught() noexcept;  // number of the first one, 0: none
};

}  // namespace enc::app
