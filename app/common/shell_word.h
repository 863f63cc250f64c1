// A word of a command, as a shell reads it back.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstring>
#include <string>

namespace enc::app {

// The word itself, or in quotes if a shell would split or interpret it.
[[nodiscard]] inline std::string shell_word(const std::string& word) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || std::strchr("._-/+,=:@", c) != nullptr;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

}  // namespace enc::app
