#include "hw_drivers/v4l2/drive/settings.h"

#include <algorithm>

namespace enc::v4l2 {

void V4l2Settings::declare(Settings& table) {
  table.value(
      {.name = "left",
       .meaning = "video device of the left camera, or of both; a name in /dev/v4l/by-path stays when "
                  "cameras are plugged in again"},
      left);
  table.value({.name = "right",
               .meaning = "video device of the right camera; empty: `left` sends both images side by side"},
              right);
  table.value({.name = "format", .meaning = "format of the pixels", .words = kWords<Pixels>}, format);
  table.value(
      {.name = "buffers", .meaning = "number of frames that the kernel may fill ahead", .low = 2, .high = 32},
      buffers);
  table.value({.name = "timeout_ms", .meaning = "longest wait for the first pair", .low = 1, .high = 1e5},
              timeout);
  table.value({.name = "silent_ms",
               .meaning = "longest time without a frame; then the link is lost",
               .low = 1,
               .high = 1e5},
              silent);
  table.value({.name = "apart_ms",
               .meaning = "largest difference of the two stamps of a pair; 0: half a period",
               .low = 0,
               .high = 1e3},
              apart);
  table.value(
      {.name = "stamp_late_ms",
       .meaning = "time from the middle of the exposure to the kernel's stamp; negative if the camera "
                  "stamps the beginning",
       .low = -1e3,
       .high = 1e3},
      stamp_late);
}

Pixels V4l2Settings::pixels() const {
  const auto at = std::find(kWords<Pixels>.begin(), kWords<Pixels>.end(), format);
  return static_cast<Pixels>(at == kWords<Pixels>.end() ? 0 : at - kWords<Pixels>.begin());
}

}  // namespace enc::v4l2
