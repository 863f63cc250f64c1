// A child process that writes to us: started, read through a pipe, ended and reaped with this object.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace enc::images {

class Child {
 public:
  // `words` are the program, searched in PATH, and its arguments. Throws Error (without a place) if there is
  // no such program.
  explicit Child(const std::vector<std::string>& words);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Waits for that many bytes; returns fewer only at the end.
  std::size_t read(char* into, std::size_t size);
  // Call from another thread: kills the process, and read() reaches the end.
  void kill() noexcept;
  // Waits for its end. Returns the first line of its standard error, or how it ended; empty on success.
  [[nodiscard]] std::string last_words();

 private:
  pid_t pid_ = -1;
  int out_ = -1, errors_ = -1;
};

}  // namespace enc::images
