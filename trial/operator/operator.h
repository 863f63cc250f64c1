// The operator of a run: the question before an armed machine first moves, and the stop and the end of the
// motion.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "trial/assemble/assemble.h"
#include "trial/operator/signals.h"
#include "trial/operator/terminal.h"
#include "trial/trial.h"

namespace enc::trial {

// True if a real device will move once it is armed.
[[nodiscard]] bool moves_device(const models::Setup& setup);
// One line for each device that will move, and one with its reach, speed or force. `devices`: their own
// descriptions.
[[nodiscard]] std::string motion_text(const models::Setup& setup, const Scene& scene,
                                      const std::vector<DeviceWords>& devices);
// That text, and the steps before Enter.
[[nodiscard]] std::string motion_question(const models::Setup& setup, const Scene& scene,
                                          const std::vector<DeviceWords>& devices);

// Throws Error (kind input) if there is no terminal for the question.
void refuse_unasked();
// Prints the question and waits for Enter, or until `stopped`. Any other line, or the end of the input, means
// no. Keys typed before the question do not count.
enum class Answer : std::uint8_t { yes, no, stopped };
[[nodiscard]] Answer ask(const std::string& question, const std::function<bool()>& stopped);

// On a terminal, space stops the motion, r resumes, q ends the run; without one,
// SIGUSR1 stops and SIGUSR2 resumes. A terminating signal or a closed terminal ends the run; a suspension
// pauses it.
class Operator {
 public:
  // Normally a suspension pauses the run, which then continues. After this call, a suspension first stops
  // everything that moves, and it stays stopped until the operator resumes.
  void stops_when_suspended() noexcept { stops_ = true; }

  // Call these in order: begin() makes signals only end the run; listen() reads the keys of the terminal.
  void begin() noexcept {
    signals_.begin();
    signals_.take_suspensions();
  }
  // Call between begin() and listen(): asks, until a signal comes.
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
