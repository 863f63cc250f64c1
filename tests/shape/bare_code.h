// The text of a source file without its comments and quotes, for a search by braces and names.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string>
#include <string_view>

namespace enc::shape {

[[nodiscard]] inline bool in_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

[[nodiscard]] inline std::string_view trim(std::string_view text) {
  const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

// The place behind the next `what` from `at` on, or the end.
[[nodiscard]] inline std::size_t behind(std::string_view text, std::string_view what, std::size_t at) {
  const std::size_t found = text.find(what, std::min(at, text.size()));
  return found == std::string_view::npos ? text.size() : found + what.size();
}

[[nodiscard]] inline std::size_t behind_quote(std::string_view text, std::size_t at) {
  const char mark = text[at++];
  while (at < text.size() && text[at] != mark) at += text[at] == '\\' ? 2 : 1;
  return std::min(at + 1, text.size());
}

// The end of the comment, directive or quote that begins at `at`; `at` if no such text begins there.
[[nodiscard]] inline std::size_t end_of_words(std::string_view text, std::size_t at) {
  const std::string_view rest = text.substr(at);
  const bool in_name = at > 0 && in_word(text[at - 1]);  // 1'000 has no quotes
  if (rest.starts_with("//")) return std::min(text.find('\n', at), text.size());
  if (rest.starts_with("/*")) return behind(text, "*/", at + 2);
  if (rest.starts_with('#')) {
    std::size_t end = at;
    do end = behind(text, "\n", end);
    while (end < text.size() && text[end - 2] == '\\');
    return end;
  }
  if (rest.starts_with("R\"") && !in_name)
    return behind(text, ")" + std::string(rest.substr(2, rest.find('(') - 2)) + "\"", at);
  return rest[0] == '"' || (rest[0] == '\'' && !in_name) ? behind_quote(text, at) : at;
}

// Removes comments, directives and quoted text; the lines stay lines.
[[nodiscard]] inline std::string bare(std::string_view text) {
  std::string code;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t end = end_of_words(text, i);
    if (end == i) {
      code += text[i++];
      continue;
    }
    code.append(static_cast<std::size_t>(std::count(text.begin() + static_cast<std::ptrdiff_t>(i),
                                                    text.begin() + static_cast<std::ptrdiff_t>(end), '\n')),
                '\n');
    i = end;
  }
  return code;
}

}  // namespace enc::shape
