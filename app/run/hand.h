// What the person at a run wants: on a terminal space stops what moves, r resumes, q ends the run; everywhere
// SIGUSR1 stops and SIGUSR2 resumes.
#pragma once

#include <cstdint>
#include <memory>

#include "app/run/signal_actions.h"
#include "trial/trial.h"

namespace enc::app {

class HandAtTheRun {
 public:
  HandAtTheRun();
  ~HandAtTheRun();  // the terminal is as it was
  HandAtTheRun(const HandAtTheRun&) = delete;
  HandAtTheRun& operator=(const HandAtTheRun&) = delete;

  // Keys are read: this process has a terminal, and its attention.
  [[nodiscard]] bool reads_keys() const noexcept { return before_ != nullptr; }
  [[nodiscard]] trial::Hand next() noexcept;  // since the last call; a stop comes before a resume
  [[nodiscard]] bool quits() const noexcept { return quits_; }

 private:
  struct Terminal;
  SignalActions actions_;
  std::unique_ptr<Terminal> before_;
  std::uint32_t calls_ = 0;
  bool quits_ = false;
};

}  // namespace enc::app
