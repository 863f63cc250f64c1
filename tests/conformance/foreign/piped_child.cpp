#include "tests/conformance/foreign/piped_child.h"

#include <csignal>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace enc::tests {

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
