// The path from the run's thread to the window: the newest snapshot and the samples of the strip charts. The
// run copies a snapshot only after the window took the last one, and it never waits.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>

#include "app/view/recorded/still.h"
#include "app/window/history/charts.h"
#include "trial/operator/queue.h"
#include "trial/operator/run_watch.h"

namespace enc::app {

// A still, and the run's status, which is drawn only for the present.
struct Snapshot {
  Still still;
  trial::RunStatus status;
};

class Feed {
 public:
  explicit Feed(trial::Trial& trial);
  Feed(const Feed&) = delete;
  Feed& operator=(const Feed&) = delete;

  // Run's thread, after each tick.
  void see(const trial::Glance& glance);

  // Run's thread, while the run stands still: the last tick, if the window has an older one.
  void catch_up();

  // Window's thread, for all functions below. True: newest() is a newer one now.
  bool take();
  [[nodiscard]] const Snapshot& newest() const { return *front_; }
  bool next(ChartSample& sample) { return samples_.pop(sample); }

 private:
  void put(const trial::Glance& glance);

  trial::Trial& trial_;
  std::unique_ptr<Snapshot> front_, back_;
  std::mutex mutex_;
  bool full_ = false;      // back_ has not been taken yet
  bool simulated_ = true;  // value of the last glance
  bool behind_ = false;    // run's thread: the last tick was not copied
  std::int64_t ticks_ = 0;
  trial::RunWatch watch_;  // run's thread, as the two below
  Sampler sampler_;
  trial::Queue<ChartSample, 8192> samples_;
};

}  // namespace enc::app
