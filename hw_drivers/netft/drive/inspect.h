// Asks a box what it is before it is told to send.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/base/time.h"
#include "hw_drivers/netft/drive/settings.h"
#include "hw_drivers/netft/wire/configuration.h"

namespace enc::netft {

// The page as it came; throws Error (kind device) where none comes.
[[nodiscard]] std::string fetch(const NetftSettings& settings, const std::string& path);

// What the command interface answers to READCALINFO; empty: nobody listens there. Throws Error (kind device)
// where somebody does and says nothing.
[[nodiscard]] std::vector<std::byte> ask_calibration(const NetftSettings& settings);
// Throws Error (kind device) where that is none, or means other units than the page.
void agree(std::span<const std::byte> answer, const Configuration& page, const NetftSettings& settings);

// What the page says. Throws Error (kind device): another device, units that nobody knows, no records, fewer
// of them than the loop needs, or less range than the rig says.
[[nodiscard]] Configuration inspect(const std::string& xml, const NetftSettings& settings, Duration period);

}  // namespace enc::netft
