// Words that several subcommands print.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/words.h"
#include "core/record/record.h"
#include "models/setup/scene_file.h"

namespace enc::app {

inline constexpr const char* kNames = "xyz";  // names of the axes

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

// `in` names the result made from the rest, "table". Empty if the record is complete.
[[nodiscard]] inline std::string lack_of(const RecordReader& record, const char* in) {
  const std::string ticks = counted(record.ticks(), "tick");
  const char* are = record.ticks() == 1 ? "is" : "are";
  if (!record.damage().empty())
    return fmt::format("{}; only the {} before it {} in the {}", record.damage(), ticks, are, in);
  if (!record.sealed())
    return fmt::format(
        "is not sealed: it was cut off, or its run was killed; the {} that it holds {} in the {}", ticks, are,
        in);
  return {};
}

// The error of all commands that need a shipped scene if there are no scenes.
[[nodiscard]] inline Error no_scenes() {
  return Error(fmt::format(
      "{}/scenes: there are no scenes; expected the models of Encounter; see to ENCOUNTER_MODELS, or "
      "leave it unset",
      models::models_dir()));
}

// Statements about named things: names with equal statements share a line.
using Statements = std::vector<std::pair<std::string, std::string>>;  // name, and the statement about it

struct SharedStatement {
  std::string what;
  std::vector<std::string> names;
};
// Ordered by the first name of each group.
[[nodiscard]] inline std::vector<SharedStatement> grouped(const Statements& said) {
  std::vector<SharedStatement> groups;
  for (const auto& [name, what] : said) {
    const auto same =
        std::find_if(groups.begin(), groups.end(),
                     [&text = what](const SharedStatement& group) { return group.what == text; });
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
