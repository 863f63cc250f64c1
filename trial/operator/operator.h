// The operator of a run. On a terminal, space stops the motion, r resumes, q ends the run; without one,
// SIGUSR1 stops and SIGUSR2 resumes. A terminating signal or a closed terminal ends the run; a suspension
// pauses it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "trial/operator/consent.h"
#include "trial/operator/keys.h"
#include "trial/operator/signals.h"
#include "trial/trial.h"

namespace enc::trial {

class Operator {
 public:
  // A suspension pauses the run, which then continues. After this call, a suspension first stops everything
  // that moves, and it stays stopped until the operator resumes.
  void stops_when_suspended() noexcept { stops_ = true; }

  // Call these in order: begin() makes signals only end the run; listen() reads the keys of the terminal.
  void begin() noexcept {
    signals_.begin();
    signals_.take_suspensions();
  }
  // Between begin() and listen(): asks (consent.h), until a signal comes.
  [[nodiscard]] Answer confirm(const std::string& question);
  void listen() {
    listens_ = true;
    keys_.begin();
  }
  void end_listening() { keys_.release(); }  // later keys belong to the shell
  [[nodiscard]] bool reads_keys() const noexcept { return keys_.reading(); }

  // The functions for TrialOptions.
  [[nodiscard]] bool stop() noexcept;
  [[nodiscard]] Hand next() noexcept;  // a stop comes before a resume

  // The signal that ended the run; 0: no signal.
  [[nodiscard]] int signal() const noexcept;
  [[nodiscard]] bool quits() const noexcept { return quits_; }

  // Called after the operator has stopped, resumed or suspended the run; `pauses` before the process is
  // suspended.
  std::function<void(Hand, bool suspended)> acts{};
  std::function<void()> pauses{};

 private:
  void suspend() noexcept;

  Signals signals_;
  Keys keys_;
  bool stops_ = false, listens_ = false, suspending_ = false, quits_ = false;
};

}  // namespace enc::trial
