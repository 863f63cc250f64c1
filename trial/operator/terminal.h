// The terminal of a run, which never blocks the loop: its keys, and standard error.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <string_view>
#include <thread>

#include "trial/time/real_time.h"

namespace enc::trial {

// Reads the keys of the terminal at standard input, one by one. A separate thread watches the terminal: on a
// busy machine the kernel can block even a non-blocking read for seconds, and the loop has no time for that.
class Keys {
 public:
  Keys();
  ~Keys();  // restores the terminal's settings
  Keys(const Keys&) = delete;
  Keys& operator=(const Keys&) = delete;

  // Reads keys from here on, while this process is in the terminal's foreground. The thread takes the
  // terminal again after a shell has changed its settings or has brought this process to the foreground.
  void begin();
  // The keys pressed since the last call, at most as many as fit. Safe in the loop: never waits.
  [[nodiscard]] std::size_t read(std::span<char> into) noexcept;
  void renew() noexcept { renew_ = true; }  // asks the thread to check the foreground soon
  // Do not call these from the loop while something moves: both may wait.
  void release();  // gives the terminal back, until take()
  void take();     // takes it, if this process is in the foreground
  [[nodiscard]] bool reading() const noexcept { return taken_; }
  [[nodiscard]] bool lost() const noexcept { return lost_; }  // the terminal was closed

 private:
  struct Terminal;
  void look(const std::stop_token& stop);
  void take_now() noexcept;

  std::mutex mutex_;                    // guards the terminal's settings
  std::unique_ptr<Terminal> terminal_;  // null: standard input is not a terminal
  bool active_ = false;                 // between take() and release()
  std::atomic<bool> taken_ = false, lost_ = false, renew_ = false;
  Queue<char, 64> pressed_;
  std::jthread thread_;
};

// Standard error that never blocks its writer. A terminal after Ctrl-S or on a dead link, or a pipe whose
// reader sleeps, gets as much as it has room for. A run that moves something writes its progress and status
// here.
class StandardError {
 public:
  StandardError();
  ~StandardError();
  StandardError(const StandardError&) = delete;
  StandardError& operator=(const StandardError&) = delete;

  // Number of bytes written without waiting; all of them if there is no reader any more.
  std::size_t write(std::string_view text) const noexcept;
  [[nodiscard]] bool terminal() const noexcept { return terminal_; }

 private:
  int own_ = -1;  // a separate non-blocking file description; the shell's own stays unchanged
  bool terminal_ = false;
};

}  // namespace enc::trial
