// Text that others wrote, as it may be shown.
#pragma once

#include <string>
#include <string_view>

namespace enc::models {

// For a terminal, on one line: what would move its cursor, change its colours or turn its letters round, and
// what is no UTF-8, stands as "\n", "\x1b" or "\u202e". Printable text is as it was.
std::string printable(std::string_view text);

}  // namespace enc::models
