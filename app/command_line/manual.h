// The manual page, encounter.1, in the language of groff.
#pragma once

#include <string>

#include "app/command_line/command_words.h"

namespace enc::app {

// `version` is "0.1.0", `day` "2026-11-30".
[[nodiscard]] std::string manual_page(const CommandWords& program, const std::string& version,
                                      const std::string& day);

}  // namespace enc::app
