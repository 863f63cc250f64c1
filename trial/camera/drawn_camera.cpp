#include "trial/camera/drawn_camera.h"

#include <utility>

#include "sim/camera/twin_camera.h"
#include "trial/time/priority.h"

namespace enc::trial {

DrawnCamera::DrawnCamera(const sim::CameraModule& module, const sim::TwinCameraSpec& spec, sim::Show show,
                         Exposure exposure)
    : spec_(spec), show_(std::move(show)), exposure_(exposure), exposures_{spec.stage.camera.rate} {
  thread_ = std::thread([this, &module] { work(module); });
  phase_.wait(Phase::drawing);
  if (phase_ != Phase::failed) return;
  thread_.join();
  std::rethrow_exception(failure_);
}

DrawnCamera::~DrawnCamera() {
  change(Phase::ended);
  thread_.join();
}

void DrawnCamera::change(Phase phase) noexcept {
  phase_ = phase;
  phase_.notify_all();
}

// An OpenGL context belongs to the thread that made it.
void DrawnCamera::work(const sim::CameraModule& module) noexcept {
  // After the loop, the fakes and vision, whose world goes on, but before other programs.
  constexpr int kLast = 99;
  come_after(kLast);
  try {
    const std::unique_ptr<sim::Stage> stage = module.stage(spec_.stage);
    renderer_ = stage->renderer();
    for (Phase before = Phase::drawing, after = Phase::idle;; before = Phase::drawing, after = Phase::drawn) {
      if (!phase_.compare_exchange_strong(before, after)) return;  // it has ended
      phase_.notify_all();
      for (Phase now = after; now != Phase::drawing; now = phase_) {
        if (now == Phase::ended) return;
        phase_.wait(now);
      }
      stage->draw(scene_, frame_, left_, right_);
    }
  } catch (...) {
    failure_ = std::current_exception();
    Phase before = Phase::drawing;
    phase_.compare_exchange_strong(before, Phase::failed);
    phase_.notify_all();
  }
}

bool DrawnCamera::due(Time now) noexcept {
  if (now < last_) exposures_.n = 0;  // the world begins again
  last_ = now;
  bool is = false;
  for (Time next = exposures_.next(); exposures_.due(now); next = exposures_.next())
    is = is || next < spec_.stalls || next >= spec_.back;
  return is;
}

void DrawnCamera::expose(Time now) noexcept {
  if (!due(now) || phase_ != Phase::idle) return;
  scene_ = show_(now);
  exposed_ = now;
  frame_ = static_cast<std::uint64_t>(exposures_.n);  // as the twin counts them
  change(Phase::drawing);
}

bool DrawnCamera::poll(Time now, Measurement<StereoFrame>& newest) noexcept {
  if (phase_ == Phase::fetched) phase_ = Phase::idle;  // the caller has done with the last picture
  if (exposure_ == Exposure::awaited) {
    expose(now);
    phase_.wait(Phase::drawing);
  }
  if (fetch(now, newest)) return true;
  if (exposure_ == Exposure::polled) expose(now);
  return false;
}

bool DrawnCamera::fetch(Time now, Measurement<StereoFrame>& newest) noexcept {
  if (phase_ == Phase::drawn) {
    const bool of_this_world = exposed_ <= now;  // else it began again meanwhile
    phase_ = of_this_world ? Phase::fetched : Phase::idle;
    if (!of_this_world) return false;
    linked_ = true;
    newest = {{left_.view(), right_.view()}, exposed_, Health::ok};
    if (now >= spec_.swaps) std::swap(newest.value.left, newest.value.right);
    return true;
  }
  if (!linked_ || !(silent(now) || phase_ == Phase::failed)) return false;
  linked_ = false;
  newest = {{}, now, Health::fault};
  return true;
}

bool DrawnCamera::silent(Time now) const noexcept {
  const Duration patience = from_seconds(sim::TwinCamera::kSilent / exposures_.hz);
  return now - patience > spec_.stalls && now < spec_.back;
}

std::string DrawnCamera::describe() const {
  const ImageSize of = size();
  return "twin, " + renderer_ + ", 2 x " + std::to_string(of.width) + " x " + std::to_string(of.height);
}

std::vector<std::string> DrawnCamera::remarks() const {
  if (phase_ != Phase::failed) return {};
  try {
    std::rethrow_exception(failure_);
  } catch (const std::exception& e) {
    return {std::string("the twin's camera draws no more: ") + e.what()};
  }
}

}  // namespace enc::trial
