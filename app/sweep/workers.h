// Processes that each do many runs: copies of this one, so that the scene's files are read and checked once,
// and a run that crashes ends only its own process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <sys/types.h>

namespace enc::app {

struct WorkerJob {
  std::function<void()> check;                   // once, before the first run: throws Error
  std::function<std::string(std::int64_t)> run;  // a run's line
  // The line of a run that ended its process so often.
  std::function<std::string(std::int64_t run, int signal, int times)> killed;
};

// Where runs come from and their lines go to; called in this process.
struct WorkerQueue {
  std::function<std::vector<std::int64_t>(std::size_t most)> next;  // empty: no more
  std::function<std::int64_t()> left;                               // runs without a line
  std::function<void(const std::string& line)> done;
  std::function<bool()> stop;  // polled: true ends all of it
};

class WorkerPool {
 public:
  WorkerPool(std::size_t workers, WorkerJob job, WorkerQueue queue);
  ~WorkerPool();  // kills the processes
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  // Throws Error if the check refuses.
  void check();
  // Returns when every run has its line, or when stop() says so: then false.
  [[nodiscard]] bool run();

 private:
  struct Worker {
    pid_t pid = -1;
    int to = -1, from = -1;         // pipes: numbers of runs, lines
    std::string text;               // begun line
    std::deque<std::int64_t> runs;  // given and not answered, in order
  };
  void start(Worker& worker);
  [[noreturn]] void work(int from, int to) const;
  void feed(Worker& worker);
  void read(Worker& worker);
  void bury(Worker& worker);        // a process that has ended: its runs are given again
  static int reap(Worker& worker);  // waits for its end; returns the signal that ended it, or 0
  void wait();

  WorkerJob job_;
  WorkerQueue queue_;
  std::vector<Worker> workers_;
  std::deque<std::int64_t> again_;        // runs of processes that were killed
  std::map<std::int64_t, int> attempts_;  // by run: processes killed during it
};

// Cores that this process may use.
[[nodiscard]] std::size_t usable_cores();

}  // namespace enc::app
