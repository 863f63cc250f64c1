#include "app/window/feed.h"

#include <utility>

#include "app/modules/modules.h"

namespace enc::app {

Feed::Feed(trial::Trial& trial)
    : trial_(trial), front_(std::make_unique<Snapshot>()), back_(std::make_unique<Snapshot>()) {}

void Feed::see(const trial::Glance& glance) {
  watch_.see(glance);
  const ChartSample sample = sampler_.sample(glance);
  if (ticks_++ % Sampler::kEach == 0) samples_.push(sample);
  const std::unique_lock lock(mutex_, std::try_to_lock);
  behind_ = !lock || full_;
  if (!behind_) put(glance);
}

void Feed::catch_up() {
  if (!behind_) return;
  const std::lock_guard lock(mutex_);
  put({trial_.scene(), trial_.now(), trial_.truth(), trial_.inputs(), trial_.outputs(), simulated_,
       &trial_.state()});
  behind_ = false;
}

void Feed::put(const trial::Glance& glance) {
  simulated_ = glance.simulated;
  take_still(trial_, glance, glance.simulated, back_->still);
  back_->status = watch_.status();
  back_->still.halted = back_->status.halted;
  full_ = true;
}

bool Feed::take() {
  const std::lock_guard lock(mutex_);
  if (!full_) return false;
  std::swap(front_, back_);
  full_ = false;
  return true;
}

namespace {

const VisionModule& vision() { return *static_cast<const VisionModule*>(load_module("vision").vision); }

}  // namespace

CameraFeed::CameraFeed(trial::Trial& trial)
    : trial_(trial),
      painter_(vision().painter(trial.setup().rig.camera)),
      view_(vision().augmented(believed_spec(trial.setup(), trial.scene()), trial.scene().objects)) {}

// The view without the machine learns the background from the first frames. Later frames cost the run's time
// only while they are shown.
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
