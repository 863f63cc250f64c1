// The keys of the terminal at standard input, one by one. A thread of its own looks at the terminal: on a
// busy machine the kernel lets even a read that is asked not to wait wait for seconds, and the loop has no
// time.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <thread>

#include "trial/operator/queue.h"

namespace enc::trial {

class Keys {
 public:
  Keys();
  ~Keys();  // the terminal has the settings that it had
  Keys(const Keys&) = delete;
  Keys& operator=(const Keys&) = delete;

  // Reads the keys of the terminal from here on, while this process is in its foreground. The thread takes
  // the terminal anew where a shell has changed its settings or has brought this process to the foreground.
  void begin();
  // The keys that were pressed since the last call, at most as many as fit. For the loop: it never waits.
  [[nodiscard]] std::size_t read(std::span<char> into) noexcept;
  void renew() noexcept { renew_ = true; }  // the thread looks soon whether it is in the foreground
  // Not for the loop while something moves: both may wait.
  void release();  // gives the terminal back, until take()
  void take();     // if this process is in the foreground
  [[nodiscard]] bool reading() const noexcept { return taken_; }
  [[nodiscard]] bool lost() const noexcept { return lost_; }  // the terminal was closed

 private:
  struct Terminal;
  void look(const std::stop_token& stop);
  void take_now() noexcept;

  std::mutex mutex_;                    // for the terminal's settings
  std::unique_ptr<Terminal> terminal_;  // none: standard input is no terminal
  bool active_ = false;                 // between take() and release()
  std::atomic<bool> taken_ = false, lost_ = false, renew_ = false;
  Queue<char, 64> pressed_;
  std::jthread thread_;
};

}  // namespace enc::trial
