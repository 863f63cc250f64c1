// Two cameras with the same view and the same exposure time [VisHap 2]. The loop never polls them: they
// belong to the tracker that uses them.
#pragma once

#include "core/base/image.h"
#include "core/base/sample.h"
#include "core/devices/device.h"

namespace enc {

// A raw pair of equal size. The camera keeps its pixels until the next poll().
struct StereoFrame {
  ImageView left, right;
};

class StereoCamera : public Device {
 public:
  // Size of each image; empty if it is known only from a frame.
  [[nodiscard]] virtual ImageSize size() const { return {}; }
  // Returns true for a newer pair, stamped with its exposure time; otherwise leaves `newest` alone.
  virtual bool poll(Time now, Stamped<StereoFrame>& newest) noexcept = 0;
};

}  // namespace enc
