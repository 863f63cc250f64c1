#include "tests/terminal/terminal.h"

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/built.h"

namespace enc::tests {
namespace {

using Clock = std::chrono::steady_clock;
void wait_ms(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

template <class Is>
bool within(double seconds, const Is& is) {
  const auto until = Clock::now() + std::chrono::duration<double>(seconds);
  while (!is()) {
    if (Clock::now() > until) return false;
    wait_ms(1);
  }
  return true;
}

}  // namespace

Terminal::Terminal() {
  winsize size{};
  size.ws_col = 200;
  size.ws_row = 50;
  // Made before the fork: several terminals may be opened from several threads.
  std::vector<std::string> variables{"ENCOUNTER_MODULES=" + module_folder(), "PS1=$ ", "TERM=dumb",
                                     "HOME=/tmp", "PATH=/usr/local/bin:/usr/bin:/bin"};
  std::vector<std::string> words{"bash", "--norc", "--noprofile", "--noediting", "-i"};
  std::vector<char*> environment, arguments;
  for (std::string& one : variables) environment.push_back(one.data());
  for (std::string& one : words) arguments.push_back(one.data());
  environment.push_back(nullptr);
  arguments.push_back(nullptr);
  static_cast<void>(fflush(nullptr));  // the child has none of it
  shell_ = forkpty(&master_, nullptr, nullptr, &size);
  if (shell_ == 0) {
    for (const int signal : {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGTSTP, SIGTTIN, SIGTTOU})
      std::signal(signal, SIG_DFL);
    close_range(3, ~0U, 0);  // else this shell keeps the terminals of other tests open
    execve("/bin/bash", arguments.data(), environment.data());
    _exit(127);
  }
  fcntl(master_, F_SETFD, FD_CLOEXEC);
  reader_ = std::thread([this] {
    std::array<char, 4096> bytes{};
    while (!over_) {
      pollfd ready{master_, POLLIN, 0};
      if (!reads_) wait_ms(2);
      if (!reads_ || poll(&ready, 1, 2) <= 0) continue;
      const ssize_t got = read(master_, bytes.data(), bytes.size());
      if (got <= 0) break;
      const std::lock_guard lock(mutex_);
      shown_.append(bytes.data(), static_cast<std::size_t>(got));
    }
  });
}

Terminal::~Terminal() {
  const pid_t left = child();
  close();
  if (left > 0 && !ends(left, 2.0)) kill(left, SIGKILL);
  kill(shell_, SIGKILL);
  waitpid(shell_, nullptr, 0);
}

void Terminal::close() {
  over_ = true;
  if (reader_.joinable()) reader_.join();
  if (master_ >= 0) ::close(master_);
  master_ = -1;
}

void Terminal::run(const std::vector<std::string>& words, const std::string& rest) {
  std::string line;
  for (const std::string& word : words) line += "'" + word + "' ";
  type(line + rest + "\n");
}

void Terminal::type(const std::string& keys) const {
  static_cast<void>(write(master_, keys.data(), keys.size()));
}

std::string Terminal::shown() const {
  const std::lock_guard lock(mutex_);
  return shown_;
}

bool Terminal::shows(const std::string& text, double seconds, std::size_t from) const {
  return within(seconds, [&] { return shown().find(text, from) != std::string::npos; });
}

pid_t Terminal::child() const {
  const std::string list =
      "/proc/" + std::to_string(shell_) + "/task/" + std::to_string(shell_) + "/children";
  pid_t found = -1;
  static_cast<void>(within(1.0, [&] { return bool(std::ifstream(list) >> found); }));
  return found;
}

bool ends(pid_t process, double seconds) {
  return within(seconds, [&] {
    std::ifstream status("/proc/" + std::to_string(process) + "/stat");
    std::string all;
    if (!std::getline(status, all)) return true;
    const std::size_t name_end = all.rfind(')');
    return name_end == std::string::npos || all.substr(name_end + 2, 1) == "Z";
  });
}

}  // namespace enc::tests
