// The path from the run's thread to the window: the newest snapshot and the samples of the strip charts. The
// run copies a snapshot only after the window took the last one, and it never waits.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>

#include "app/view/moment/moment.h"
#include "app/window/history/history.h"
#include "core/vision/vision_module.h"
#include "trial/operator/run_watch.h"
#include "trial/time/real_time.h"

namespace enc::app {

// A still, and the run's status, which is drawn only for the present.
struct Snapshot {
  RunSnapshot still;
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

  // Window's thread, for all functions below. Returns true if newest() is a newer snapshot now.
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

// The path of a scene's camera images: vision's results in them, and the user's view without the machine. It
// draws nothing until the window has taken the last images.
class CameraFeed {
 public:
  // Requires a twin's camera in the scene, and a module of vision.
  explicit CameraFeed(trial::Trial& trial);
  CameraFeed(const CameraFeed&) = delete;
  CameraFeed& operator=(const CameraFeed&) = delete;

  // Run's thread: look() before the tracker sees a frame, see() after each tick.
  void look(const Measurement<StereoFrame>& frame) { frame_ = frame.value; }
  void see();

  // Window's thread.
  struct Pictures {
    SeenPair pair;
    Image augmented;
  };
  void want(bool pair, bool augmented) {
    pairs_ = pair;
    augments_ = augmented;
  }
  // Newer pictures; unset: no newer ones.
  [[nodiscard]] std::optional<Pictures> take();

 private:
  trial::Trial& trial_;
  std::unique_ptr<SeenPainter> painter_;
  std::unique_ptr<AugmentedView> view_;
  BelievedMoment moment_;
  std::optional<StereoFrame> frame_;      // a frame not drawn yet
  static constexpr int kBackground = 60;  // first frames, from which the background is learned
  int frames_ = 0;
  std::atomic<bool> pairs_ = false, augments_ = false;
  std::mutex mutex_;
  std::optional<Pictures> made_;
};

}  // namespace enc::app
