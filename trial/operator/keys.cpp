#include "trial/operator/keys.h"

#include <cerrno>

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

namespace enc::trial {

// A file description of our own never blocks, and leaves the one that the shell shares as it is. Where the
// system gives none, standard input itself is asked, after a look whether a key is there.
struct Keys::Terminal {
  int fd = open("/proc/self/fd/0", O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  termios before{};
  ~Terminal() {
    if (fd >= 0) close(fd);
  }
  // How many bytes came; 0: none yet; -1: the terminal was closed.
  [[nodiscard]] ssize_t read(std::span<char> into) const noexcept {
    pollfd ready{STDIN_FILENO, POLLIN, 0};
    if (fd < 0 && poll(&ready, 1, 0) <= 0) return 0;
    errno = 0;
    const ssize_t got = ::read(fd >= 0 ? fd : STDIN_FILENO, into.data(), into.size());
    if (got > 0) return got;
    // A read from the background fails, too, and another program may have made Ctrl-D an end.
    return errno != EAGAIN && isatty(STDIN_FILENO) == 0 ? -1 : 0;
  }
};

Keys::Keys() = default;
Keys::~Keys() { release(); }

bool Keys::in_foreground() const noexcept { return tcgetpgrp(STDIN_FILENO) == getpgrp(); }

void Keys::begin() noexcept {
  if (isatty(STDIN_FILENO) == 0) return;
  terminal_ = std::make_unique<Terminal>();
  take();
}

void Keys::take() noexcept {
  if (!terminal_ || lost_ || !in_foreground()) return;
  termios now{};
  if (tcgetattr(STDIN_FILENO, &now) != 0) return;
  if (!taken_) terminal_->before = now;
  taken_ = true;
  if ((now.c_lflag & (ICANON | ECHO)) == 0) return;
  now.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);  // Ctrl-C and Ctrl-Z stay signals
  now.c_cc[VMIN] = 1;
  now.c_cc[VTIME] = 0;
  tcsetattr(STDIN_FILENO, TCSANOW, &now);
}

// In the background the terminal belongs to another program.
void Keys::release() noexcept {
  if (taken_ && in_foreground()) tcsetattr(STDIN_FILENO, TCSANOW, &terminal_->before);
  taken_ = false;
}

std::size_t Keys::read(std::span<char> into) noexcept {
  constexpr std::uint32_t kLook = 16 * kSeldom;  // calls
  if (!terminal_ || lost_ || ++calls_ % kSeldom != 0) return 0;
  if (calls_ % kLook == 0) take();
  const ssize_t got = terminal_->read(into);
  lost_ = got < 0;
  return got > 0 ? static_cast<std::size_t>(got) : 0;
}

}  // namespace enc::trial
