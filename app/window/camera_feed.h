// The path of a scene's camera images from the run's thread to the window: vision's results in them, and the
// user's view without the machine. It draws nothing until the window has taken the last images.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>

#include "app/view/moment/believed.h"
#include "core/vision/vision_module.h"

namespace enc::app {

class CameraFeed {
 public:
  // Requires a twin's camera in the scene, and a module of vision.
  explicit CameraFeed(trial::Trial& trial);
  CameraFeed(const CameraFeed&) = delete;
  CameraFeed& operator=(const CameraFeed&) = delete;

  // Run's thread: look() before the tracker sees a frame, see() after each tick.
  void look(const Stamped<StereoFrame>& frame) { frame_ = frame.value; }
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
