#include "trial/operator/standard_error.h"

#include <algorithm>
#include <cerrno>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

namespace enc::trial {

StandardError::StandardError() : terminal_(isatty(STDERR_FILENO) != 0) {
  struct stat what {};
  // A file takes what it is given, and has a place of its own in each description.
  if (fstat(STDERR_FILENO, &what) != 0 || S_ISREG(what.st_mode)) return;
  own_ = open("/proc/self/fd/2", O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
}

StandardError::~StandardError() {
  if (own_ >= 0) close(own_);
}

std::size_t StandardError::write(std::string_view text) const noexcept {
  // A socket, say, cannot be opened again: it takes so much at once or says beforehand that it does not.
  constexpr std::size_t kMostAtOnce = 1024;  // bytes; PIPE_BUF is 4096
  std::size_t taken = 0;
  while (taken < text.size()) {
    pollfd ready{STDERR_FILENO, POLLOUT, 0};
    if (own_ < 0 && poll(&ready, 1, 0) <= 0) break;
    const ssize_t got = ::write(own_ >= 0 ? own_ : STDERR_FILENO, text.data() + taken,
                                std::min(text.size() - taken, kMostAtOnce));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && errno == EAGAIN) break;
    if (got < 0) return text.size();
    taken += static_cast<std::size_t>(got);
  }
  return taken;
}

}  // namespace enc::trial
