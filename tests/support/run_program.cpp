#include "tests/support/run_program.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/built.h"

namespace enc::tests {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// "NAME=value" from our environment and the given one. Made before fork(), after which a threaded parent must
// not allocate.
std::vector<std::string> whole_environment(const Environment& extra) {
  std::vector<std::string> all;
  for (char** line = environ; *line != nullptr; ++line) {
    const std::string text = *line;
    bool replaced = false;
    for (const auto& [name, value] : extra)
      replaced = replaced || (text.starts_with(name) && text[name.size()] == '=');
    if (!replaced) all.push_back(text);
  }
  for (const auto& [name, value] : extra) all.push_back(name + "=" + value);
  return all;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> list;
  list.reserve(texts.size() + 1);
  for (std::string& text : texts) list.push_back(text.data());
  list.push_back(nullptr);
  return list;
}

struct Pipe {
  std::array<int, 2> end{-1, -1};
  // Close-on-exec: otherwise a child of another test would keep our pipe open.
  Pipe() {
    if (pipe2(end.data(), O_CLOEXEC) != 0) end = {-1, -1};
  }
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close_end(std::size_t i) {
    if (end[i] >= 0) close(end[i]);
    end[i] = -1;
  }
};

[[noreturn]] void become(char* const* argv, char* const* envp, const Pipe& out, const Pipe& err) {
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  dup2(nothing, STDIN_FILENO);
  dup2(out.end[1], STDOUT_FILENO);
  dup2(err.end[1], STDERR_FILENO);
  execvpe(argv[0], argv, envp);
  _exit(127);
}

// Reads both pipes until they close; both together, because a full one stops the child. Returns false after
// the timeout.
bool read_all(Pipe& out, Pipe& err, Result& result, Clock::time_point start, double timeout) {
  std::array<pollfd, 2> polled{{{out.end[0], POLLIN, 0}, {err.end[0], POLLIN, 0}}};
  std::array<std::string*, 2> texts{&result.out, &result.err};
  std::array<char, 65536> buffer;
  while (polled[0].fd >= 0 || polled[1].fd >= 0) {
    const double left = timeout - since(start);
    if (left <= 0.0) return false;
    if (poll(polled.data(), polled.size(), static_cast<int>(left * 1e3) + 1) < 0 && errno != EINTR)
      return false;
    for (std::size_t i = 0; i < polled.size(); ++i) {
      if (polled[i].fd < 0 || polled[i].revents == 0) continue;
      const ssize_t n = read(polled[i].fd, buffer.data(), buffer.size());
      if (n > 0) texts[i]->append(buffer.data(), static_cast<std::size_t>(n));
      if (n == 0 || (n < 0 && errno != EINTR)) polled[i].fd = -1;  // poll() skips it
    }
  }
  return true;
}

// A child may close its output and continue, so the wait has the timeout, too.
int wait_for(pid_t child, Clock::time_point start, double timeout, bool give_up) {
  int status = 0;
  while (!give_up && waitpid(child, &status, WNOHANG) == 0) {
    give_up = since(start) > timeout;
    usleep(500);
  }
  if (give_up) {
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

Result run(const std::vector<std::string>& command, const Environment& environment, double timeout) {
  Result result;
  std::vector<std::string> args = command, lines = whole_environment(environment);
  const std::vector<char*> argv = pointers(args), envp = pointers(lines);
  Pipe out, err;
  const Clock::time_point start = Clock::now();
  const pid_t child = fork();
  if (child == 0) become(argv.data(), envp.data(), out, err);
  if (child < 0) return result;
  out.close_end(1);
  err.close_end(1);
  const bool in_time = read_all(out, err, result, start, timeout);
  result.code = wait_for(child, start, timeout, !in_time);
  result.seconds = since(start);
  return result;
}

Result run_program(const std::vector<std::string>& args, const Environment& environment, double timeout) {
  std::vector<std::string> command{program_file()};
  command.insert(command.end(), args.begin(), args.end());
  return run(command, environment, timeout);
}

PipedChild::PipedChild(std::vector<std::string> words) {
  std::array<int, 2> in{-1, -1}, out{-1, -1};
  if (pipe2(in.data(), O_CLOEXEC) != 0 || pipe2(out.data(), O_CLOEXEC) != 0)
    throw std::runtime_error("no pipe");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in[0], 0);
  posix_spawn_file_actions_adddup2(&actions, out[1], 1);
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const int failed = posix_spawnp(&pid_, pointers.front(), &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(in[0]);
  ::close(out[1]);
  ends_ = {in[1], out[0]};
  if (failed != 0) throw std::runtime_error(words.front() + " cannot be started");
}

PipedChild::~PipedChild() {
  if (pid_ > 0) ::kill(pid_, SIGKILL);
  end();
}

void PipedChild::close(std::size_t end) {
  if (const int file = std::exchange(ends_[end], -1); file >= 0) ::close(file);
}

std::size_t PipedChild::read(std::span<char> into, int milliseconds) {
  pollfd one{ends_[1], POLLIN, 0};
  if (closed_ || poll(&one, 1, milliseconds) <= 0) return 0;
  const ssize_t n = ::read(ends_[1], into.data(), into.size());
  closed_ = n <= 0;
  return n > 0 ? static_cast<std::size_t>(n) : 0;
}

int PipedChild::end() {
  close(0);
  int status = 0;
  if (pid_ > 0) waitpid(std::exchange(pid_, -1), &status, 0);
  close(1);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace enc::tests
