#include "benchmarks/kit/child.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>

#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace enc::bench {
namespace {

class MemoryFile {
 public:
  explicit MemoryFile(const std::string& text = {}) : fd_(memfd_create("child", MFD_CLOEXEC)) {
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t n = write(fd_, text.data() + done, text.size() - done);
      if (n <= 0) break;
      done += static_cast<std::size_t>(n);
    }
    lseek(fd_, 0, SEEK_SET);
  }
  ~MemoryFile() { close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  [[nodiscard]] int fd() const { return fd_; }
  [[nodiscard]] std::string text() const {
    std::string all;
    std::array<char, 65536> buffer;
    lseek(fd_, 0, SEEK_SET);
    for (ssize_t n = 0; (n = read(fd_, buffer.data(), buffer.size())) > 0;)
      all.append(buffer.data(), static_cast<std::size_t>(n));
    return all;
  }

 private:
  int fd_;
};

// A Ctrl-C in the terminal is for us, not for a picture half drawn: the child has a group of its own. What we
// block, it must not.
struct Spawn {
  posix_spawnattr_t attributes{};
  posix_spawn_file_actions_t files{};
  Spawn() {
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawn_file_actions_init(&files);
  }
  ~Spawn() {
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
  }
  Spawn(const Spawn&) = delete;
  Spawn& operator=(const Spawn&) = delete;
};

double seconds_of(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

}  // namespace

Child run_child(std::vector<std::string> words, const std::string& input) {
  const MemoryFile in(input), out, err;
  Spawn spawn;
  posix_spawn_file_actions_adddup2(&spawn.files, in.fd(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&spawn.files, out.fd(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&spawn.files, err.fd(), STDERR_FILENO);
  std::vector<char*> list;
  list.reserve(words.size() + 1);
  for (std::string& word : words) list.push_back(word.data());
  list.push_back(nullptr);
  Child child;
  pid_t pid = 0;
  const auto start = std::chrono::steady_clock::now();
  if (posix_spawnp(&pid, list.front(), &spawn.files, &spawn.attributes, list.data(), environ) != 0)
    return child;
  child.started = true;
  int status = 0;
  rusage usage{};
  while (wait4(pid, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  child.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  child.cpu = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  if (WIFEXITED(status)) child.code = WEXITSTATUS(status);
  child.out = out.text();
  child.err = err.text();
  return child;
}

}  // namespace enc::bench
