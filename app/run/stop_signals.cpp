#include "app/run/stop_signals.h"

#include <csignal>

namespace enc::app {
namespace {

volatile std::sig_atomic_t first_signal = 0;

extern "C" void note_signal(int number) {
  if (first_signal == 0) first_signal = number;
}

}  // namespace

StopSignals::StopSignals() {
  first_signal = 0;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    actions_.take(signal, note_signal, static_cast<int>(SA_RESETHAND), true);
  actions_.take(SIGPIPE, SIG_IGN);  // a pipe without a reader is an error of that pipe
}

int StopSignals::caught() noexcept { return first_signal; }

}  // namespace enc::app
