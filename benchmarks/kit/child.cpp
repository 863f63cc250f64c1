#include "benchmarks/kit/child.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string_view>
#include <thread>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.h"

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
  // Reads the file so far. The writer shares the file offset, and reading must not move it.
  [[nodiscard]] std::string text() const {
    std::string all;
    std::array<char, 65536> buffer;
    for (ssize_t n = 0; (n = pread(fd_, buffer.data(), buffer.size(), static_cast<off_t>(all.size()))) > 0;)
      all.append(buffer.data(), static_cast<std::size_t>(n));
    return all;
  }

 private:
  int fd_;
};

// A Ctrl-C in the terminal must not end a half-drawn picture: the child has its own process group. It must
// not inherit our blocked signals.
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

std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> list;
  list.reserve(words.size() + 1);
  for (std::string& word : words) list.push_back(word.data());
  list.push_back(nullptr);
  return list;
}

// Runs between fork() and the program: it must not allocate or lock.
[[noreturn]] void become(char* const* words, int in, int out, int err, pid_t parent) {
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(127);  // the parent that would end this child is gone
  dup2(in, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  execv(words[0], words);
  _exit(127);
}

// "encounter fake"
std::string short_name(const std::vector<std::string>& words) {
  const std::string& file = words.front();
  return file.substr(file.rfind('/') + 1) + (words.size() > 1 ? " " + words[1] : "");
}

// The first line of the child's error text, without its own name in front.
std::string why_ended(const std::string& said) {
  constexpr std::string_view kName = "encounter: ";
  const std::string line = said.substr(0, said.find('\n'));
  if (line.empty()) return "it ended before it had begun";
  return line.starts_with(kName) ? line.substr(kName.size()) : line;
}

double seconds_of(const timeval& t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

}  // namespace

std::string this_program() {
  std::error_code none;
  return std::filesystem::read_symlink("/proc/self/exe", none).string();
}

Child run_child(std::vector<std::string> words, const std::string& input) {
  const MemoryFile in(input), out, err;
  Spawn spawn;
  posix_spawn_file_actions_adddup2(&spawn.files, in.fd(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&spawn.files, out.fd(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&spawn.files, err.fd(), STDERR_FILENO);
  const std::vector<char*> list = pointers_to(words);
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

Companion::Companion(std::vector<std::string> words, const std::string& ready, double longest) {
  using SteadyClock = std::chrono::steady_clock;
  const MemoryFile in, out, err;
  const std::string name = short_name(words);
  const std::vector<char*> list = pointers_to(words);
  const pid_t parent = getpid();
  child_ = fork();
  if (child_ == 0) become(list.data(), in.fd(), out.fd(), err.fd(), parent);
  if (child_ < 0) throw Error(name + ": could not be started: there is no room for another process");
  const auto until = SteadyClock::now() + std::chrono::duration<double>(longest);
  while (out.text().find(ready) == std::string::npos) {
    int status = 0;
    if (waitpid(child_, &status, WNOHANG) == child_) {
      child_ = -1;
      const bool device = WIFEXITED(status) && WEXITSTATUS(status) == static_cast<int>(ErrorKind::device);
      throw Error(name + ": " + why_ended(err.text()), {}, device ? ErrorKind::device : ErrorKind::input);
    }
    if (SteadyClock::now() > until) {
      end();
      throw Error(fmt::format("{}: was silent for {:g} s", name, longest), {}, ErrorKind::device);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

Companion::~Companion() { end(); }

void Companion::end() {
  if (child_ < 0) return;
  kill(child_, SIGTERM);
  bool ended = false;
  for (int i = 0; i < 1000 && !ended; ++i) {
    ended = waitpid(child_, nullptr, WNOHANG) != 0;
    if (!ended) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (!ended) {
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
  child_ = -1;
}

}  // namespace enc::bench
