#include "app/sweep/workers.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/base/error.h"

namespace enc::app {
namespace {

constexpr std::int64_t kCheck = -1;    // in place of a run's number
constexpr std::size_t kBatch = 100;    // runs given at once, fewer near the end
constexpr int kAttempts = 3;           // processes that a run may end
constexpr int kPollPeriod = 200;       // ms
constexpr const char* kGood = "good";  // answer to a check

bool read_number(int fd, std::int64_t& number) {
  auto* to = reinterpret_cast<char*>(&number);
  for (std::size_t have = 0; have < sizeof(number);) {
    const ssize_t n = read(fd, to + have, sizeof(number) - have);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    have += static_cast<std::size_t>(n);
  }
  return true;
}

bool write_whole(int fd, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t n = write(fd, data, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    data += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

[[noreturn]] void refuse_process() {
  throw Error("there is no room for another process; expected one for each core; end other programs");
}

// Becomes a process of its own group, which ends with its parent and takes every signal. It keeps none of the
// parent's files but its two pipes, which become 3 and 4.
void settle(pid_t parent, int& from, int& to) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  std::signal(SIGPIPE, SIG_DFL);
  const int in = fcntl(from, F_DUPFD, 10), out = fcntl(to, F_DUPFD, 10);
  from = dup2(in, STDERR_FILENO + 1);
  to = dup2(out, STDERR_FILENO + 2);
  close_range(static_cast<unsigned>(STDERR_FILENO) + 3, ~0U, 0);
}

}  // namespace

std::size_t usable_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return sched_getaffinity(0, sizeof(set), &set) == 0 ? static_cast<std::size_t>(CPU_COUNT(&set)) : 1;
}

WorkerPool::WorkerPool(std::size_t workers, WorkerJob job, WorkerQueue queue)
    : job_(std::move(job)), queue_(std::move(queue)), workers_(std::max<std::size_t>(1, workers)) {
  std::signal(SIGPIPE, SIG_IGN);  // a worker that has ended is found by its other pipe
}

WorkerPool::~WorkerPool() {
  for (Worker& worker : workers_) {
    if (worker.pid < 0) continue;
    kill(worker.pid, SIGKILL);
    reap(worker);
  }
}

void WorkerPool::start(Worker& worker) {
  std::array<int, 2> to{}, from{};
  if (pipe2(to.data(), O_CLOEXEC) != 0) refuse_process();
  if (pipe2(from.data(), O_CLOEXEC) != 0) refuse_process();
  std::fflush(nullptr);  // else both processes print what is in the buffers
  const pid_t parent = getpid();
  worker.pid = fork();
  if (worker.pid < 0) refuse_process();
  if (worker.pid == 0) {
    settle(parent, to[0], from[1]);
    work(to[0], from[1]);
  }
  close(to[0]);
  close(from[1]);
  worker.to = to[1];
  worker.from = from[0];
}

void WorkerPool::work(int from, int to) const {
  for (std::int64_t run = 0; read_number(from, run);) {
    std::string line;
    try {
      if (run == kCheck)
        job_.check();
      else
        line = job_.run(run);
      if (run == kCheck) line = kGood;
    } catch (const std::exception& e) {
      line = e.what();
    }
    line += '\n';
    if (!write_whole(to, line.data(), line.size())) break;
  }
  _exit(0);
}

void WorkerPool::check() {
  Worker& worker = workers_.front();
  start(worker);
  if (!write_whole(worker.to, reinterpret_cast<const char*>(&kCheck), sizeof(kCheck)))
    throw Error("a process of the sweep ended before it had begun");
  while (worker.text.find('\n') == std::string::npos) {
    if (queue_.stop()) return;
    pollfd one{worker.from, POLLIN, 0};
    if (poll(&one, 1, kPollPeriod) <= 0) continue;
    std::array<char, 4096> buffer{};
    const ssize_t n = ::read(worker.from, buffer.data(), buffer.size());
    if (n <= 0) throw Error("the process that checks the sweep was killed; begin anew");
    worker.text.append(buffer.data(), static_cast<std::size_t>(n));
  }
  const std::string answer = worker.text.substr(0, worker.text.find('\n'));
  worker.text.clear();
  if (answer != kGood) throw Error(answer);
}

bool WorkerPool::run() {
  while (queue_.left() > 0) {
    if (queue_.stop()) return false;
    for (Worker& worker : workers_) feed(worker);
    wait();
  }
  return true;
}

// Keeps a worker one run ahead, so that it never waits.
void WorkerPool::feed(Worker& worker) {
  if (worker.runs.size() > 1) return;
  const std::size_t share = static_cast<std::size_t>(queue_.left()) / (4 * workers_.size());
  const std::size_t most = std::clamp<std::size_t>(share, 1, kBatch);
  std::vector<std::int64_t> runs;
  for (; !again_.empty() && runs.size() < most; again_.pop_front()) runs.push_back(again_.front());
  if (runs.empty()) runs = queue_.next(most);
  if (runs.empty()) return;
  if (worker.pid < 0) start(worker);
  worker.runs.insert(worker.runs.end(), runs.begin(), runs.end());
  // If the process has just ended, its other pipe says so, and the runs are given again.
  static_cast<void>(
      write_whole(worker.to, reinterpret_cast<const char*>(runs.data()), runs.size() * sizeof(std::int64_t)));
}

void WorkerPool::wait() {
  std::vector<pollfd> pipes;
  std::vector<Worker*> at;
  for (Worker& worker : workers_) {
    if (worker.pid < 0) continue;
    pipes.push_back({worker.from, POLLIN, 0});
    at.push_back(&worker);
  }
  if (poll(pipes.data(), pipes.size(), kPollPeriod) <= 0) return;
  for (std::size_t i = 0; i < pipes.size(); ++i)
    if (pipes[i].revents != 0) read(*at[i]);
}

void WorkerPool::read(Worker& worker) {
  std::array<char, 65536> buffer{};
  const ssize_t n = ::read(worker.from, buffer.data(), buffer.size());
  if (n < 0 && errno == EINTR) return;
  if (n <= 0) return bury(worker);
  worker.text.append(buffer.data(), static_cast<std::size_t>(n));
  std::size_t begin = 0;
  for (std::size_t end = 0; (end = worker.text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    queue_.done(worker.text.substr(begin, end - begin));
    worker.runs.pop_front();
  }
  worker.text.erase(0, begin);
}

int WorkerPool::reap(Worker& worker) {
  close(worker.to);
  close(worker.from);
  int status = 0;
  while (waitpid(worker.pid, &status, 0) < 0 && errno == EINTR) {
  }
  worker.pid = -1;
  return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
}

// The first of its runs was under way. A kill from outside may hit any run, so it is tried again.
void WorkerPool::bury(Worker& worker) {
  const int signal = reap(worker);
  if (!worker.runs.empty()) {
    const std::int64_t run = worker.runs.front();
    const int times = ++attempts_[run];
    if (times >= kAttempts) {
      worker.runs.pop_front();
      queue_.done(job_.killed(run, signal, times));
    }
    again_.insert(again_.begin(), worker.runs.begin(), worker.runs.end());
  }
  worker = {};
}

}  // namespace enc::app
