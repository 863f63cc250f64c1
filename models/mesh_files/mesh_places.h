// Places that a mesh's nearest points are asked for: a table with the columns x_m,y_m,z_m and no others.
#pragma once

#include <string>
#include <vector>

#include "core/base/frames.h"

namespace enc::models {

// path: for messages "path:line:column: ...". Throws Error: another header, no number, a place beyond 1e6 m.
[[nodiscard]] std::vector<Vec3> parse_places(const std::string& text, const std::string& path);

}  // namespace enc::models
