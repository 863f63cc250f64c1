// A program that writes to us and runs until we close its input.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include <sys/types.h>

namespace enc::tests {

class PipedChild {
 public:
  explicit PipedChild(std::vector<std::string> words);  // the program and what it is told; it must be there
  ~PipedChild();                                        // killed, where it still runs
  PipedChild(const PipedChild&) = delete;
  PipedChild& operator=(const PipedChild&) = delete;

  // What came, after at most so many ms; 0: nothing, or closed().
  std::size_t read(std::span<char> into, int milliseconds);
  [[nodiscard]] bool closed() const { return closed_; }
  // Closes its input and waits for its end; the exit code.
  int end();

 private:
  void close(std::size_t end);

  pid_t pid_ = -1;
  std::array<int, 2> ends_{-1, -1};  // its input and its output
  bool closed_ = false;
};

}  // namespace enc::tests
