#include "app/window/camera_feed.h"

#include <utility>

#include "app/modules/modules.h"

namespace enc::app {
namespace {

const VisionModule& vision() { return *static_cast<const VisionModule*>(load_module("vision").vision); }

}  // namespace

CameraFeed::CameraFeed(trial::Trial& trial)
    : trial_(trial),
      painter_(vision().painter(trial.setup().rig.camera)),
      view_(vision().augmented(believed_spec(trial.setup(), trial.scene()), trial.scene().objects)) {}

// The view without the machine learns the background from the first frames. Later ones cost the run's time
// only while somebody looks.
void CameraFeed::see() {
  if (!frame_) return;
  const StereoFrame frame = *frame_;
  frame_.reset();
  const AugmentedMoment moment = moment_.of(trial_);
  if (augments_ || frames_++ < kBackground) view_->see(frame.left, moment);
  if (!pairs_ && !augments_) return;
  if (const std::lock_guard lock(mutex_); made_) return;
  Pictures made;
  if (augments_)
    made.augmented = view_->augmented();
  else
    made.pair = painter_->draw(frame, *trial_.rig().tracker);
  const std::lock_guard lock(mutex_);
  made_ = std::move(made);
}

std::optional<CameraFeed::Pictures> CameraFeed::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(made_, std::nullopt);
}

}  // namespace enc::app
