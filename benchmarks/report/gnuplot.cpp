// The child process that draws. Script, picture and complaints go through memory files, so nothing is left
// behind.
#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <string>

#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "benchmarks/report/plot.h"

namespace enc::bench {
namespace {

class MemoryFile {
 public:
  explicit MemoryFile(const std::string& text = {}) : fd_(memfd_create("gnuplot", MFD_CLOEXEC)) {
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

std::string first_complaint(const std::string& text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = std::min(text.find('\n', i), text.size());
    const std::string line = text.substr(i, end - i);
    if (line.find_first_not_of(" \t^") != std::string::npos && line.find("gnuplot>") == std::string::npos)
      return line;
    i = end + 1;
  }
  return "it said nothing";
}

}  // namespace

Drawing draw(const Plot& plot) {
  const MemoryFile script(plot_script(plot));
  const MemoryFile picture;
  const MemoryFile complaints;
  Spawn spawn;
  posix_spawn_file_actions_adddup2(&spawn.files, script.fd(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&spawn.files, picture.fd(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&spawn.files, complaints.fd(), STDERR_FILENO);
  std::string name = "gnuplot";
  std::string plain = "-d";  // without what the user's own start-up file says
  std::string standard_input = "-";
  std::array<char*, 4> words{name.data(), plain.data(), standard_input.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, name.c_str(), &spawn.files, &spawn.attributes, words.data(), environ) != 0)
    return {"", "gnuplot is missing (Debian: gnuplot-nox)"};
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  std::string svg = picture.text();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || svg.find("</svg>") == std::string::npos)
    return {"", plot.id + ": gnuplot failed: " + first_complaint(complaints.text())};
  return {std::move(svg), ""};
}

}  // namespace enc::bench
