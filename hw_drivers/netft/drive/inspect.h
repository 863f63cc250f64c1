// Asks a box what it is before it is told to send.
#pragma once

#include <string>

#include "core/time.h"
#include "hw_drivers/netft/drive/settings.h"
#include "hw_drivers/netft/wire/configuration.h"

namespace enc::netft {

// The page as it came; throws Error (kind device) where none comes.
[[nodiscard]] std::string fetch(const NetftSettings& settings, const std::string& path);

// What the page says. Throws Error (kind device): another device, units that nobody knows, no records, fewer
// of them than the loop needs, or less range than the rig says.
[[nodiscard]] Configuration inspect(const std::string& xml, const NetftSettings& settings, Duration period);

}  // namespace enc::netft
