// Standard error that never blocks its writer. A terminal after Ctrl-S or on a dead link, or a pipe whose
// reader sleeps, gets as much as it has room for. A run that moves something writes its progress and status
// here.
#pragma once

#include <cstddef>
#include <string_view>

namespace enc::trial {

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
