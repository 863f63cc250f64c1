// Handles the signals of a process that may run a machine. Each signal that can be caught ends or pauses the
// run, however often it comes; the machine always gets its stop and the record its seal.
#pragma once

#include <array>
#include <csignal>
#include <cstddef>

namespace enc::trial {

// Only one object may exist at a time. Before begin() a terminating signal ends the process at once, with
// exit code 128 + its number: a start-up may compute for minutes. After begin() signals are only noted.
//
// A signal that was ignored before, as by nohup, stays ignored. A pipe without a reader (SIGPIPE) and a file
// that may not grow (SIGXFSZ) become errors of that file. Terminal access from the background (SIGTTIN,
// SIGTTOU) fails instead of stopping the process. A fault of this program (SIGSEGV, SIGABRT, ...) keeps its
// earlier handling.
class Signals {
 public:
  Signals();
  ~Signals();  // restores the earlier handling of each signal
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  void begin() noexcept;
  // Also notes a suspension (SIGTSTP) from here on; suspend() carries it out.
  void take_suspensions() noexcept;

  // The number of the first signal that asked for the end; 0: no signal.
  [[nodiscard]] static int caught() noexcept;
  // Each returns true once for all signals since the last call.
  [[nodiscard]] static bool take_halt() noexcept;        // SIGUSR1
  [[nodiscard]] static bool take_resume() noexcept;      // SIGUSR2
  [[nodiscard]] static bool take_suspension() noexcept;  // SIGTSTP
  [[nodiscard]] static bool take_continued() noexcept;   // SIGCONT

  // Stops this process, as SIGTSTP normally does, until it is continued.
  void suspend() noexcept;

 private:
  // Earlier handling of a signal that stays.
  enum class PriorHandling { nothing, ignored, handled };
  void take(int signal, void (*handler)(int), PriorHandling spared);
  void take_faults();

  struct SavedSignal {
    int signal = 0;
    struct sigaction before {};
  };
  static constexpr std::size_t kMost = 64;
  std::array<SavedSignal, kMost> taken_{};
  std::size_t count_ = 0;
};

}  // namespace enc::trial
