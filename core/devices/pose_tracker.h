// Any source of tool or fingertip poses: optical tracker, stereo vision, a script, a recording [VHMR 3.3].
#pragma once

#include "core/base/sample.h"
#include "core/devices/device.h"

namespace enc {

class PoseTracker : public Device {
 public:
  // Returns true for a new pose; otherwise leaves `newest` alone.
  virtual bool poll(Time now, Stamped<TrackedTool>& newest) noexcept = 0;
};

}  // namespace enc
