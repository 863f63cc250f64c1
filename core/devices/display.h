// Where the user sees the scene: headset or window. It also says which deformed surface it drew, late
// [VHMR 3.5].
#pragma once

#include "core/base/sample.h"
#include "core/devices/device.h"
#include "core/devices/view.h"

namespace enc {

class Display : public Device {
 public:
  virtual void show(const View& view) noexcept = 0;  // newest only; never blocks
  virtual bool poll(Time now,
                    Stamped<DentSample>& newest) noexcept = 0;  // true when a drawn surface came back
};

}  // namespace enc
