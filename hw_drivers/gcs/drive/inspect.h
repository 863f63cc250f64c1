// Inspects a controller before any command, without a motion.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "core/machine/hexapod.h"
#include "hw_drivers/gcs/drive/settings.h"
#include "hw_drivers/gcs/wire/coordinates.h"

namespace enc::gcs {

// Sends a line and returns the whole answer; throws Error (kind device) if no answer comes.
using Ask = std::function<std::string(std::string_view line)>;

struct ControllerInfo {
  std::string identity;  // "C-887.53 119012345"
  std::string firmware;
  double velocity = kUnset;  // m/s, platform
  Stand stand;
  Travel travel;
  Coordinates at{};       // present position
  int left_over = 0;      // an earlier error, which the query has cleared
  bool fake = false;      // it identifies itself as a fake
  bool lockstep = false;  // a fake whose time advances only with each set-point
};

// Throws Error (kind device): another device, not referenced, a servo off, or less than the rig states.
[[nodiscard]] ControllerInfo inspect(const Ask& ask, const GcsSettings& settings, const Reach& promised);

}  // namespace enc::gcs
