// The path of a scene's camera images from the run's thread to the window: what vision saw in them, and the
// user's view without the machine. Nothing is drawn while the window has not taken the last ones.
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
  // The scene has a camera of the twin, and there is a module of vision.
  explicit CameraFeed(trial::Trial& trial);
  CameraFeed(const CameraFeed&) = delete;
  CameraFeed& operator=(const CameraFeed&) = delete;

  // Run's thread: a frame before the tracker sees it, and after each tick.
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
  // Newer ones; unset: there are none.
  [[nodiscard]] std::optional<Pictures> take();

 private:
  trial::Trial& trial_;
  std::unique_ptr<SeenPainter> painter_;
  std::unique_ptr<AugmentedView> view_;
  BelievedMoment moment_;
  std::optional<StereoFrame> frame_;      // that was not drawn yet
  static constexpr int kBackground = 60;  // frames at the beginning, from which the background is known
  int frames_ = 0;
  std::atomic<bool> pairs_ = false, augments_ = false;
  std::mutex mutex_;
  std::optional<Pictures> made_;
};

}  // namespace enc::app
