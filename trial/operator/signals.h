// The signals of a process that may run a machine. Each one that can be caught ends or pauses the run,
// however often it comes; none leaves a machine without its stop or a record without its seal.
#pragma once

#include <array>
#include <csignal>
#include <cstddef>

namespace enc::trial {

// One at a time. Before begin() nothing has been begun, so a signal that ends a process ends this one at
// once, with exit code 128 + its number: a start-up may compute for minutes. After begin() signals are only
// noted.
//
// A signal that was ignored before, as by nohup, stays ignored. A pipe without a reader (SIGPIPE) and a file
// that may not grow (SIGXFSZ) are errors of that file. Terminal access from the background (SIGTTIN, SIGTTOU)
// fails instead of stopping the process. A fault of this program (SIGSEGV, SIGABRT, ...) does what it did
// before.
class Signals {
 public:
  Signals();
  ~Signals();  // each signal does again what it did before
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  void begin() noexcept;
  // A suspension (SIGTSTP) is noted, too, and suspend() carries it out.
  void take_suspensions() noexcept;

  // The number of the first signal that asked for the end; 0: none did.
  [[nodiscard]] static int caught() noexcept;
  // Each is true once for whatever came since the last call.
  [[nodiscard]] static bool take_halt() noexcept;        // SIGUSR1
  [[nodiscard]] static bool take_resume() noexcept;      // SIGUSR2
  [[nodiscard]] static bool take_suspension() noexcept;  // SIGTSTP
  [[nodiscard]] static bool take_continued() noexcept;   // SIGCONT

  // Stops this process as SIGTSTP does by itself, until it is continued.
  void suspend() noexcept;

 private:
  // What a signal did before, and goes on to do.
  enum class Spared { nothing, ignored, handled };
  void take(int signal, void (*handler)(int), Spared spared);
  void take_faults();

  struct Taken {
    int signal = 0;
    struct sigaction before {};
  };
  static constexpr std::size_t kMost = 64;
  std::array<Taken, kMost> taken_{};
  std::size_t count_ = 0;
};

}  // namespace enc::trial
