// The person at a run. On a terminal space stops what moves, r resumes, q ends the run; elsewhere SIGUSR1
// stops and SIGUSR2 resumes. A signal that ends a process ends the run, and so does a terminal that is
// closed; a suspension pauses it.
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
  // A suspension pauses the run, which goes on afterwards. After this call it stops first what moves, which
  // then stands until somebody resumes.
  void stops_when_suspended() noexcept { stops_ = true; }

  // In this order: a signal only ends the run; the keys of the terminal are read.
  void begin() noexcept {
    signals_.begin();
    signals_.take_suspensions();
  }
  // Between the two: asks (consent.h), until a signal comes.
  [[nodiscard]] Answer confirm(const std::string& question);
  void listen() {
    listens_ = true;
    keys_.begin();
  }
  void end_listening() { keys_.release(); }  // what is typed from here on is for the shell
  [[nodiscard]] bool reads_keys() const noexcept { return keys_.reading(); }

  // As TrialOptions wants them.
  [[nodiscard]] bool stop() noexcept;
  [[nodiscard]] Hand next() noexcept;  // a stop comes before a resume

  // What ended it: a signal, 0: none did.
  [[nodiscard]] int signal() const noexcept;
  [[nodiscard]] bool quits() const noexcept { return quits_; }

  // Called where the person stopped, resumed or suspended the run; and before the process is suspended.
  std::function<void(Hand, bool suspended)> acts{};
  std::function<void()> pauses{};

 private:
  void suspend() noexcept;

  Signals signals_;
  Keys keys_;
  bool stops_ = false, listens_ = false, suspending_ = false, quits_ = false;
};

}  // namespace enc::trial
