#include "trial/operator/terminal.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include "trial/time/real_time.h"

namespace enc::trial {

// A separate file description never blocks, and does not change the one shared with the shell. If the system
// provides none, standard input itself is read when poll() reports a key.
struct Keys::Terminal {
  int fd = open("/proc/self/fd/0", O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  termios before{};
  ~Terminal() {
    if (fd >= 0) close(fd);
  }
  // Number of bytes read; 0: no key; -1: the terminal was closed.
  [[nodiscard]] ssize_t read(std::span<char> into) const noexcept {
    pollfd ready{STDIN_FILENO, POLLIN, 0};
    if (fd < 0 && poll(&ready, 1, 0) <= 0) return 0;
    errno = 0;
    const ssize_t got = ::read(fd >= 0 ? fd : STDIN_FILENO, into.data(), into.size());
    if (got > 0) return got;
    // A read from the background also fails, and another program may have set Ctrl-D to end the input.
    return errno != EAGAIN && isatty(STDIN_FILENO) == 0 ? -1 : 0;
  }
};

Keys::Keys() = default;
Keys::~Keys() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
  release();
}

void Keys::begin() {
  if (isatty(STDIN_FILENO) == 0) return;
  terminal_ = std::make_unique<Terminal>();
  take();
  thread_ = beside_loop([this](const std::stop_token& stop) { look(stop); });
}

void Keys::look(const std::stop_token& stop) {
  constexpr std::chrono::milliseconds kTurn{5};
  constexpr int kSettings = 40;  // turns between two checks of the settings
  for (int turn = 1; !stop.stop_requested(); ++turn) {
    std::this_thread::sleep_for(kTurn);
    const std::lock_guard lock(mutex_);
    if (!active_) continue;
    if (renew_.exchange(false) || turn % kSettings == 0) take_now();
    std::array<char, 64> keys{};
    const ssize_t got = terminal_->read(keys);
    for (ssize_t i = 0; i < got; ++i) pressed_.push(keys[static_cast<std::size_t>(i)]);
    if (got >= 0) continue;
    lost_ = true;
    return;
  }
}

void Keys::take() {
  const std::lock_guard lock(mutex_);
  active_ = true;
  take_now();
}

void Keys::take_now() noexcept {
  if (!terminal_ || lost_ || tcgetpgrp(STDIN_FILENO) != getpgrp()) return;
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

// A background process leaves the terminal alone, since it belongs to another program.
void Keys::release() {
  const std::lock_guard lock(mutex_);
  active_ = false;
  if (taken_ && tcgetpgrp(STDIN_FILENO) == getpgrp()) tcsetattr(STDIN_FILENO, TCSANOW, &terminal_->before);
  taken_ = false;
}

std::size_t Keys::read(std::span<char> into) noexcept {
  std::size_t count = 0;
  while (count < into.size() && pressed_.pop(into[count])) ++count;
  return count;
}

StandardError::StandardError() : terminal_(isatty(STDERR_FILENO) != 0) {
  struct stat what {};
  // A file never blocks, and a second description would have its own write position.
  if (fstat(STDERR_FILENO, &what) != 0 || S_ISREG(what.st_mode)) return;
  own_ = open("/proc/self/fd/2", O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
}

StandardError::~StandardError() {
  if (own_ >= 0) close(own_);
}

std::size_t StandardError::write(std::string_view text) const noexcept {
  // A socket, for example, cannot be opened again. It either takes this many bytes at once, or poll() reports
  // that it does not.
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
