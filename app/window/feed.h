// The path from the run's thread to the window: the newest snapshot and the samples of the strip charts. The
// run copies a snapshot only after the window took the last one, and it never waits.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>

#include "app/view/moment.h"
#include "trial/operator/queue.h"
#include "trial/operator/run_watch.h"

namespace enc::app {

struct ChartSample {
  float t = 0.0F;                                             // s
  float measured = 0.0F, filtered = 0.0F, true_force = 0.0F;  // N, along the surface's normal
  float deflection = 0.0F, gap = 0.0F;                        // mm
};

// A copy of everything that a picture of one tick needs.
struct Snapshot {
  sim::DataPtr data;
  sim::Truth truth;
  State state;
  Outputs out;
  Tick now;
  Pose<'R', 'H'> platform;
  Quat q_WT = Quat::Identity();
  trial::RunStatus status;
  bool simulated = true;  // every device: the truth knows what is touched
};

class Feed {
 public:
  explicit Feed(trial::Trial& trial);
  Feed(const Feed&) = delete;
  Feed& operator=(const Feed&) = delete;

  // Run's thread, after each tick.
  void see(const trial::Glance& glance);

  // Window's thread, as all below. True: newest() is a newer one now.
  bool take();
  [[nodiscard]] Snapshot& newest() { return *front_; }
  [[nodiscard]] Moment moment();  // of newest()
  bool next(ChartSample& sample) { return samples_.pop(sample); }

 private:
  void copy(const trial::Glance& glance);

  static constexpr std::int64_t kSampleEach = 5;  // ticks
  trial::Trial& trial_;
  std::unique_ptr<Snapshot> front_, back_;
  std::mutex mutex_;
  bool full_ = false;  // back_ has not been taken yet
  std::int64_t ticks_ = 0;
  trial::RunWatch watch_;  // run's thread
  trial::Queue<ChartSample, 8192> samples_;
};

}  // namespace enc::app
