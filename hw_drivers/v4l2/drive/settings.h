// [driver.v4l2] of a rig file.
#pragma once

#include <cstdint>
#include <string>

#include "core/spec/settings.h"
#include "hw_drivers/v4l2/wire/pixels.h"

namespace enc::v4l2 {

struct V4l2Settings {
  std::string left = "/dev/video0", right;  // right empty: both images side by side in one
  std::string format{word_of(Pixels::yuyv)};
  std::int64_t buffers = 4;
  double timeout = 3.0;     // s
  double silent = 0.5;      // s
  double apart = 0.0;       // s; 0: half a period
  double stamp_late = 0.0;  // s

  void declare(Settings& table);
  [[nodiscard]] Pixels pixels() const;
};

}  // namespace enc::v4l2
