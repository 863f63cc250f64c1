#include "hw_drivers/images/play/child.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.h"

extern char** environ;  // NOLINT: POSIX has it

namespace enc::images {

Child::Child(const std::vector<std::string>& words) {
  std::array<int, 2> ends{-1, -1};
  errors_ = memfd_create("errors", MFD_CLOEXEC);  // of any length: a full pipe would stop the child
  if (errors_ < 0 || pipe2(ends.data(), O_CLOEXEC) != 0)
    throw Error(fmt::format("{} cannot be started: {}", words.front(), std::strerror(errno)));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
  posix_spawn_file_actions_adddup2(&actions, errors_, 2);
  // Signals that a terminal sends to all are for us: we end the child ourselves.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const int failed = posix_spawnp(&pid_, arguments.front(), &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  close(ends[1]);
  out_ = ends[0];
  if (failed == 0) return;
  close(out_);
  close(errors_);
  throw Error(fmt::format("{} cannot be started: {}", words.front(), std::strerror(failed)));
}

// Reaped here alone: until then its number is its own, and kill() meets nobody else.
Child::~Child() {
  kill();
  while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
  close(out_);
  close(errors_);
}

std::size_t Child::read(char* into, std::size_t size) {
  std::size_t got = 0;
  while (got < size) {
    const ssize_t n = ::read(out_, into + got, size - got);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    got += static_cast<std::size_t>(n);
  }
  return got;
}

// With all that it has started, which may hold the pipe, too.
void Child::kill() noexcept { ::kill(-pid_, SIGKILL); }

std::string Child::last_words() {
  siginfo_t end{};
  while (waitid(P_PID, static_cast<id_t>(pid_), &end, WEXITED | WNOWAIT) < 0 && errno == EINTR) {
  }
  std::array<char, 512> text{};
  const ssize_t n = pread(errors_, text.data(), text.size() - 1, 0);
  std::string line(text.data(), n > 0 ? static_cast<std::size_t>(n) : 0);
  line.resize(std::min(line.find('\n'), line.size()));
  if (const std::size_t part = line.find("] "); line.starts_with('[') && part != std::string::npos)
    line.erase(0, part + 2);  // which part of ffmpeg says it, and where that is in memory
  if (!line.empty()) return line;
  if (end.si_code != CLD_EXITED) return fmt::format("ended by signal {}", end.si_status);
  return end.si_status == 0 ? "" : fmt::format("exit code {}", end.si_status);
}

}  // namespace enc::images
