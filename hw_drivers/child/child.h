// A child process behind a pipe. This object starts it, reads or writes it, and kills and reaps it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <sys/types.h>

namespace enc {

class Child {
 public:
  // Direction of the pipe: this process reads the child's standard output or writes its standard input.
  enum class Pipe : std::uint8_t { read, write };
  struct End {
    bool success;
    std::string how;    // "exit code 1", "ended by signal 9"
    std::string error;  // first line of its standard error; may be empty
  };

  // `words` are the program, searched in PATH unless it has a '/', and its arguments. Throws Error (without a
  // place) if there is no such program.
  Child(const std::vector<std::string>& words, Pipe pipe);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Waits for that many bytes; returns fewer only at the end.
  std::size_t read(char* into, std::size_t size);
  // Waits until the child has taken all bytes; returns false if it takes no more.
  bool write(std::span<const std::uint8_t> bytes);
  // Call from another thread: kills the process and all that it has started, and read() reaches the end.
  void kill() noexcept;
  // Ends the child's input if the pipe writes, and waits for the child to end.
  [[nodiscard]] End wait();

 private:
  pid_t pid_ = -1;
  int pipe_ = -1, errors_ = -1;
  bool writes_;
};

}  // namespace enc
