// Query points for a mesh's nearest points: a table with exactly the columns x_m,y_m,z_m.
#pragma once

#include <string>
#include <vector>

#include "core/base/frames.h"

namespace enc::models {

// path: for messages "path:line:column: ...". Throws Error: another header, not a number, a point beyond 1e6
// m.
[[nodiscard]] std::vector<Vec3> parse_places(const std::string& text, const std::string& path);

}  // namespace enc::models
