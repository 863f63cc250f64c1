// Two cameras that look at the same scene and are exposed at the same time [VisHap 2]. Nothing of the loop
// polls it: it belongs to the tracker that looks through it.
#pragma once

#include "core/base/image.h"
#include "core/base/sample.h"
#include "core/devices/device.h"

namespace enc {

// A raw pair, of equal size. Its pixels stay until the next poll().
struct StereoFrame {
  ImageView left, right;
};

class StereoCamera : public Device {
 public:
  // Of each image; none where only frames tell.
  [[nodiscard]] virtual ImageSize size() const { return {}; }
  // True when there is a newer pair, stamped with when it was exposed; leaves `newest` alone otherwise.
  virtual bool poll(Time now, Stamped<StereoFrame>& newest) noexcept = 0;
};

}  // namespace enc
