// A program that writes to us: started, read through a pipe, ended and reaped with the object.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace enc::images {

class Child {
 public:
  // `words` are the program, looked for in PATH, and what it is told. Throws Error (without a place) where
  // there is none.
  explicit Child(const std::vector<std::string>& words);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // Waits for that many bytes; fewer only at the end.
  std::size_t read(char* into, std::size_t size);
  // From another thread: it is killed, and read() comes to the end.
  void kill() noexcept;
  // Waits for its end; the first line that it said as an error, or how it ended; empty where all was well.
  [[nodiscard]] std::string last_words();

 private:
  pid_t pid_ = -1;
  int out_ = -1, errors_ = -1;
};

}  // namespace enc::images
