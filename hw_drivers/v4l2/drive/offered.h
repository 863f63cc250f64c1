// The formats that a video device offers, for messages.
#pragma once

#include <string>

#include "hw_drivers/v4l2/wire/system.h"

namespace enc::v4l2 {

// "YUYV 640 x 480 at 15, 30 Hz; MJPG 1280 x 480 at 30 Hz": at most kMostOffered sizes. Empty: the device
// lists none.
inline constexpr int kMostOffered = 12;
[[nodiscard]] std::string offered_by(System& system, int descriptor);

}  // namespace enc::v4l2
