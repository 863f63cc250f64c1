// Asks a controller what it is before it is told anything. Nothing moves.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "core/machine/reach.h"
#include "hw_drivers/gcs/drive/settings.h"
#include "hw_drivers/gcs/wire/travel.h"

namespace enc::gcs {

// Sends a line and gives the whole answer; throws Error (kind device) where none comes.
using Ask = std::function<std::string(std::string_view line)>;

struct Found {
  std::string identity;  // "C-887.53 119012345"
  std::string firmware;
  double velocity = kUnset;  // of the platform, m/s
  Stand stand;
  Travel travel;
  Coordinates at{};       // where it stands
  int left_over = 0;      // an error that was there before: to ask for it clears it
  bool fake = false;      // and says so
  bool lockstep = false;  // a fake whose time goes on with each set-point, and not by itself
};

// Throws Error (kind device): another device, not referenced, a servo off, or less than the rig promises.
[[nodiscard]] Found inspect(const Ask& ask, const GcsSettings& settings, const Reach& promised);

}  // namespace enc::gcs
