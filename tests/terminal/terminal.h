// A person's terminal: an interactive shell on a pseudo-terminal, keys that are typed, and all that is shown.
#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <sys/types.h>

namespace enc::tests {

class Terminal {
 public:
  // With bash as its shell, which has job control and sends SIGHUP to its jobs when the terminal is closed.
  Terminal();
  ~Terminal();  // closes it, and kills what is left
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  // Types a command line, each word quoted, with the rest as it is.
  void run(const std::vector<std::string>& words, const std::string& rest = {});
  void type(const std::string& keys) const;  // as they are: "\x03" is Ctrl-C
  void close();
  void hang(bool hangs) { reads_ = !hangs; }  // its link: nobody reads what is written to it

  // All that was shown so far.
  [[nodiscard]] std::string shown() const;
  // Waits until that has this text behind `from`; false after so many seconds.
  [[nodiscard]] bool shows(const std::string& text, double seconds, std::size_t from = 0) const;
  // The program that the shell runs; -1: none within a second.
  [[nodiscard]] pid_t child() const;

 private:
  int master_ = -1;
  pid_t shell_ = -1;
  mutable std::mutex mutex_;
  std::string shown_;
  std::atomic<bool> over_ = false, reads_ = true;
  std::thread reader_;
};

// Whether a process has ended within so many seconds.
[[nodiscard]] bool ends(pid_t process, double seconds);

}  // namespace enc::tests
