#include "hw_drivers/v4l2/drive/lockstep_camera.h"

#include <utility>

#include "hw_drivers/v4l2/wire/relay.h"

namespace enc::v4l2 {

LockstepCamera::LockstepCamera(const Offer& offer, const V4l2Settings& settings,
                               std::unique_ptr<System> system)
    : system_(std::move(system)),
      size_(offer.rig.camera.size()),
      capture_(*system_, settings, size_, offer.rig.camera.rate),
      words_(capture_.describe()) {}

bool LockstepCamera::poll(Time now, Measurement<StereoFrame>& newest) noexcept {
  if (!capture_.turn(Duration{}, picture_)) return false;
  const Time exposed(picture_.exposed - kLockstepZero);
  if (exposed > now) return false;  // from the world of an earlier client
  newest = {{picture_.left.view(), picture_.right.view()}, exposed, Health::ok};
  return true;
}

std::vector<std::string> LockstepCamera::remarks() const { return {capture_.remark(capture_.counts())}; }

}  // namespace enc::v4l2
