#include "app/window/feed.h"

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

}  // namespace enc::app
