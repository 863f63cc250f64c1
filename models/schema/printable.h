// Makes foreign text safe to show.
#pragma once

#include <string>
#include <string_view>

namespace enc::models {

// Text for a terminal, on one line. Characters that would move its cursor, change its colours or reverse its
// letters, and invalid UTF-8, become "\n", "\x1b" or "\u202e". Printable text stays unchanged.
std::string printable(std::string_view text);

}  // namespace enc::models
