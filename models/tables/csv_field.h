// A field of a table that is written.
#pragma once

#include <string>

namespace enc::models {

// Quotes a field where RFC 4180 requires it.
[[nodiscard]] inline std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

}  // namespace enc::models
