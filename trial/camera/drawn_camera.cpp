#include "trial/camera/drawn_camera.h"

#include <utility>

#include "trial/time/priority.h"

namespace enc::trial {

DrawnCamera::DrawnCamera(const sim::CameraModule& module, const sim::StageSpec& stage, sim::Show show,
                         bool waits)
    : size_(stage.camera.size()), show_(std::move(show)), waits_(waits), exposures_{stage.camera.rate} {
  thread_ = std::thread([this, &module, stage] { work(module, stage); });
  std::unique_lock lock(changes_);
  change_.wait(lock, [this] { return phase_ != Phase::drawing || failure_; });
  if (!failure_) return;
  lock.unlock();
  thread_.join();
  std::rethrow_exception(failure_);
}

DrawnCamera::~DrawnCamera() {
  {
    const std::lock_guard lock(changes_);
    stop_ = true;
  }
  change_.notify_all();
  thread_.join();
}

// An OpenGL context belongs to the thread that made it.
void DrawnCamera::work(const sim::CameraModule& module, const sim::StageSpec& spec) noexcept {
  come_after(1);  // the fakes, whose world goes on while a picture is drawn
  try {
    const std::unique_ptr<sim::Stage> stage = module.stage(spec);
    std::unique_lock lock(changes_);
    phase_ = Phase::idle;
    change_.notify_all();
    while (true) {
      change_.wait(lock, [this] { return stop_ || phase_ == Phase::drawing; });
      if (stop_) return;
      lock.unlock();
      stage->draw(scene_, frame_, left_, right_);
      lock.lock();
      phase_ = Phase::drawn;
      change_.notify_all();
    }
  } catch (...) {
    const std::lock_guard lock(changes_);
    failure_ = std::current_exception();
    change_.notify_all();
  }
}

bool DrawnCamera::due(Time now) noexcept {
  if (now < last_) exposures_.n = 0;  // the world begins again
  last_ = now;
  bool is = false;
  while (exposures_.due(now)) is = true;
  return is;
}

bool DrawnCamera::poll(Time now, Measurement<StereoFrame>& newest) noexcept {
  const bool is_due = due(now);
  if (waits_ && is_due && phase_ == Phase::idle) {
    expose(now);
    std::unique_lock lock(changes_);
    change_.wait(lock, [this] { return phase_ != Phase::drawing || failure_; });
  }
  if (phase_ == Phase::drawn) {
    phase_ = Phase::idle;
    newest = {{left_.view(), right_.view()}, exposed_, Health::ok};
    if (exposed_ <= now) return true;  // else from before the world began again
  }
  if (!waits_ && is_due && phase_ == Phase::idle) expose(now);
  return false;
}

void DrawnCamera::expose(Time now) noexcept {
  scene_ = show_(now);
  exposed_ = now;
  frame_ = static_cast<std::uint64_t>(exposures_.n);  // as the twin counts them
  {
    const std::lock_guard lock(changes_);
    phase_ = Phase::drawing;
  }
  change_.notify_all();
}

}  // namespace enc::trial
