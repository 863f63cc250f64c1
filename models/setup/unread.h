// Tables of rig and truth that a run of a scene does not read.
#pragma once

#include <string>
#include <vector>

#include "models/setup/scene_file.h"

namespace enc::models {

// "truth.ball" for a scene without [probe], "rig.arm" for one without [arm]
[[nodiscard]] std::vector<std::string> unread_tables(const Setup& setup);

}  // namespace enc::models
