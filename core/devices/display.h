// The headset or window that shows the scene to the user. It also reports, late, which deformed surface it
// drew [VHMR 3.5].
#pragma once

#include "core/base/sample.h"
#include "core/devices/device.h"
#include "core/devices/view.h"

namespace enc {

class Display : public Device {
 public:
  virtual void show(const View& view) noexcept = 0;  // newest only; never blocks
  // Returns true if a new drawn surface came back.
  virtual bool poll(Time now, Stamped<DentSample>& newest) noexcept = 0;
};

}  // namespace enc
