#include "sim/camera/twin_camera.h"

#include <exception>
#include <utility>

#include "core/base/error.h"

namespace enc::sim {

TwinCamera::TwinCamera(const TwinCameraSpec& spec, Show show)
    : spec_(spec), show_(std::move(show)), stage_(spec.stage), exposures_{spec.stage.camera.rate, 0, {}} {
  if (!(exposures_.hz > 0.0 && exposures_.hz <= 1000.0))
    throw Error("a camera's rate is 0 to 1000 Hz", "truth.camera.rate_hz");
  if (!show_) throw Error("a camera of the twin needs what it looks at");
}

bool TwinCamera::poll(Time now, Measurement<StereoFrame>& newest) noexcept {
  bool due = false;
  for (Time next = exposures_.next(); exposures_.due(now); next = exposures_.next())
    due = due || next < spec_.stalls || next >= spec_.back;
  if (!due || !failure_.empty()) return silent(now, newest);
  try {
    stage_.draw(show_(now), static_cast<std::uint64_t>(exposures_.n), left_, right_);
  } catch (const std::exception& e) {
    failure_ = e.what();  // the reason, stored once
    return silent(now, newest);
  }
  ++drawn_;
  exposed_ = now;
  linked_ = true;
  newest = {{left_.view(), right_.view()}, now, Health::ok};
  if (now >= spec_.swaps) std::swap(newest.value.left, newest.value.right);
  return true;
}

bool TwinCamera::silent(Time now, Measurement<StereoFrame>& newest) noexcept {
  if (!linked_ || age(now, exposed_) <= kSilent / exposures_.hz) return false;
  linked_ = false;
  newest = {{left_.view(), right_.view()}, exposed_, Health::fault};
  return true;
}

std::vector<std::string> TwinCamera::remarks() const {
  if (failure_.empty()) return {};
  return {"the twin's camera draws no more: " + failure_};
}

std::string TwinCamera::describe() const {
  const StereoRig& c = spec_.stage.camera;
  return std::string("twin, ") + stage_.renderer() + ", 2 x " + std::to_string(c.width) + " x " +
         std::to_string(c.height);
}

}  // namespace enc::sim
