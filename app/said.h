// Statements about named things: names with equal statements share a line.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace enc::app {

using Said = std::vector<std::pair<std::string, std::string>>;  // name, and the statement about it

struct SaidOf {
  std::string what;
  std::vector<std::string> names;
};
// Ordered by the first name of each group.
[[nodiscard]] inline std::vector<SaidOf> grouped(const Said& said) {
  std::vector<SaidOf> groups;
  for (const auto& [name, what] : said) {
    const auto same = std::find_if(groups.begin(), groups.end(),
                                   [&text = what](const SaidOf& group) { return group.what == text; });
    if (same == groups.end())
      groups.push_back({what, {name}});
    else
      same->names.push_back(name);
  }
  return groups;
}

// "a, b, c", or "a, b and 10 more".
[[nodiscard]] inline std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 3;
  const std::size_t shown = names.size() > kMost ? kMost - 1 : names.size();
  std::string text;
  for (std::size_t i = 0; i < shown; ++i) text += (i == 0 ? "" : ", ") + names[i];
  return shown == names.size() ? text : text + fmt::format(" and {} more", names.size() - shown);
}

}  // namespace enc::app
