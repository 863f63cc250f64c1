#include "app/run/stop_signals.h"

#include <array>
#include <csignal>

namespace enc::app {
namespace {

constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t first = 0;
std::array<struct sigaction, kSignals.size()> before{};
struct sigaction before_pipe {};

extern "C" void note_signal(int number) {
  if (first == 0) first = number;
}

}  // namespace

StopSignals::StopSignals() {
  first = 0;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    struct sigaction action {};
    action.sa_handler = note_signal;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigaction(kSignals[i], nullptr, &before[i]);
    if (before[i].sa_handler != SIG_IGN) sigaction(kSignals[i], &action, nullptr);
  }
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;  // a pipe without a reader is an error of that pipe
  sigaction(SIGPIPE, &ignore, &before_pipe);
}

StopSignals::~StopSignals() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before[i], nullptr);
  sigaction(SIGPIPE, &before_pipe, nullptr);
}

int StopSignals::caught() noexcept { return first; }

}  // namespace enc::app
