#include "tests/unit/hw_drivers/v4l2/drive/virtual_video.h"

#include <algorithm>

#include <poll.h>

namespace enc::v4l2 {

void VirtualVideo::wait(std::span<const int> descriptors, Duration most) noexcept {
  for (const int descriptor : descriptors) {
    CameraRun& camera = of(descriptor);
    pollfd ready{camera.node.event(), POLLIN, 0};
    if (!plugged(camera) || ::poll(&ready, 1, 0) > 0) return;
  }
  run_to(now_ + most, true);
}

void VirtualVideo::run_to(Duration until, bool first) {
  while (true) {
    CameraRun* due = nullptr;
    double when = seconds(until);
    for (const auto& camera : cameras_) {
      const double at = std::max(camera->camera.exposed(camera->next) + camera->camera.delay, camera->after);
      if (at < when) when = at, due = camera.get();
    }
    if (due == nullptr) break;
    now_ = std::max(now_, from_seconds(when));
    if (deliver(*due) && first) return;
  }
  now_ = until;
}

bool VirtualVideo::deliver(CameraRun& of) {
  const std::int64_t n = of.next++;
  of.after = seconds(now_) + of.camera.jitter * uniform(of);
  if (!plugged(of)) return true;  // wakes the waiting driver
  if (of.camera.lost.contains(n)) return false;
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(of.node.mode().width) *
                                  static_cast<std::size_t>(of.node.mode().height));
  for (int i = 0; i < 4; ++i)
    bytes[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(n >> (24 - 8 * i));
  const double stamp = of.camera.exposed(n) + of.camera.stamp_error * (2.0 * uniform(of) - 1.0);
  return of.node.put(static_cast<std::uint32_t>(n), from_seconds(of.camera.sets_stamps ? stamp : 0.0), bytes,
                     of.camera.damaged.contains(n));
}

}  // namespace enc::v4l2
