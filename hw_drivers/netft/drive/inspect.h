// Inspects a box before it is asked to send.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/base/time.h"
#include "hw_drivers/netft/drive/settings.h"
#include "hw_drivers/netft/wire/configuration.h"

namespace enc::netft {

// The raw HTTP page; throws Error (kind device) if no page comes.
[[nodiscard]] std::string fetch(const NetftSettings& settings, const std::string& path);

// The answer of the command interface to READCALINFO; empty: no server listens there. Throws Error (kind
// device) if a server accepts and does not answer.
[[nodiscard]] std::vector<std::byte> ask_calibration(const NetftSettings& settings);
// Throws Error (kind device) if the answer is invalid, or if its units differ from the page's.
void agree(std::span<const std::byte> answer, const Configuration& page, const NetftSettings& settings);

// The content of the page. Throws Error (kind device): another device, unknown units, no records, fewer of
// them than the loop needs, or less range than the rig states.
[[nodiscard]] Configuration inspect(const std::string& xml, const NetftSettings& settings, Duration period);

}  // namespace enc::netft
