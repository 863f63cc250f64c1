// Standard error that keeps nobody waiting: a terminal after Ctrl-S or at the end of a dead link, or a pipe
// whose reader sleeps, takes what it has room for. Progress and status of a run that moves something are
// written with it.
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

  // How many bytes were taken without waiting. All of them where there is no reader any more.
  std::size_t write(std::string_view text) const noexcept;
  [[nodiscard]] bool terminal() const noexcept { return terminal_; }

 private:
  int own_ = -1;  // a file description that does not block; the shell's own stays as it is
  bool terminal_ = false;
};

}  // namespace enc::trial
