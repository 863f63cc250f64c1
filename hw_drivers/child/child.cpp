#include "hw_drivers/child/child.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.h"

extern char** environ;  // NOLINT: POSIX has it

namespace enc {

Child::Child(const std::vector<std::string>& words, Pipe pipe) : writes_(pipe == Pipe::write) {
  std::array<int, 2> ends{-1, -1};
  // Memory file without a size limit: a full pipe would stop the child.
  errors_ = memfd_create("errors", MFD_CLOEXEC);
  if (errors_ < 0 || pipe2(ends.data(), O_CLOEXEC) != 0)
    throw Error(fmt::format("{} cannot be started: {}",
                            std::filesystem::path(words.front()).filename().string(), std::strerror(errno)));
  const int childs = ends[writes_ ? 0 : 1];
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, childs, writes_ ? 0 : 1);
  posix_spawn_file_actions_addopen(&actions, writes_ ? 1 : 0, "/dev/null", writes_ ? O_WRONLY : O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, errors_, 2);
  // The child gets its own process group. A terminal's signals then reach only this process, which ends the
  // child.
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
  close(childs);
  pipe_ = ends[writes_ ? 1 : 0];
  if (failed == 0) return;
  close(pipe_);
  close(errors_);
  throw Error(fmt::format("{} cannot be started: {}", words.front(), std::strerror(failed)));
}

// Only this destructor reaps the child. Until then its process number stays its own, and kill() hits no other
// process.
Child::~Child() {
  kill();
  while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
  if (pipe_ >= 0) close(pipe_);
  close(errors_);
}

std::size_t Child::read(char* into, std::size_t size) {
  std::size_t got = 0;
  while (got < size) {
    const ssize_t n = ::read(pipe_, into + got, size - got);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    got += static_cast<std::size_t>(n);
  }
  return got;
}

bool Child::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(pipe_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

// Kill the whole group, because processes that the child started may also hold the pipe.
void Child::kill() noexcept { ::kill(-pid_, SIGKILL); }

Child::End Child::wait() {
  if (writes_ && pipe_ >= 0) close(std::exchange(pipe_, -1));
  siginfo_t end{};
  while (waitid(P_PID, static_cast<id_t>(pid_), &end, WEXITED | WNOWAIT) < 0 && errno == EINTR) {
  }
  std::array<char, 512> text{};
  const ssize_t n = pread(errors_, text.data(), text.size() - 1, 0);
  std::string line(text.data(), n > 0 ? static_cast<std::size_t>(n) : 0);
  line.resize(std::min(line.find('\n'), line.size()));
  const bool exited = end.si_code == CLD_EXITED;
  return {exited && end.si_status == 0,
          fmt::format("{} {}", exited ? "exit code" : "ended by signal", end.si_status), line};
}

}  // namespace enc
