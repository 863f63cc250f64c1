// A program whose input and output are ours: what it writes we read, what we write it reads.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

namespace enc::tests {

class PipedChild {
 public:
  explicit PipedChild(std::vector<std::string> words);  // the program and what it is told; it must be there
  ~PipedChild();                                        // killed, where it still runs
  PipedChild(const PipedChild&) = delete;
  PipedChild& operator=(const PipedChild&) = delete;

  void write(std::string_view bytes) const;
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
