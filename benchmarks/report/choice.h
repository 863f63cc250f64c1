// Parses the words after `bench`: benchmarks, groups of them, figures or the beginnings of their ids.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "benchmarks/kit/entry.h"

namespace enc::bench {

struct Group {
  const char* name;
  const char* what;
  std::vector<std::string> members;  // names that do not exist are skipped
};
[[nodiscard]] std::span<const Group> groups();

struct Choice {
  const Benchmark* benchmark;
  std::vector<std::string> ids;  // whole ids or their first tokens; empty: all figures
};
// Result in the order named, each benchmark once; no words: all. Throws Error for an unknown word.
[[nodiscard]] std::vector<Choice> chosen(const std::vector<std::string>& words);
// Filters for --set: keeps the benchmarks that read each of these parameters. Another one is refused if it
// was named (throws Error with the closest parameter), else left out; `left` has the names left out.
[[nodiscard]] std::vector<Choice> settable(std::vector<Choice> choices, const std::vector<std::string>& set,
                                           bool named, const std::string& models,
                                           std::vector<std::string>& left);
// Filters for --rig: keeps the benchmarks that can run over devices. Another one is refused if it was named,
// else left out silently.
[[nodiscard]] std::vector<Choice> over_devices(std::vector<Choice> choices, bool named);
[[nodiscard]] bool wanted(const Choice& choice, const Figure& figure);
// Checks ids after a run, because only a run has them. Throws Error, with the nearest id, for an unknown id.
void check_ids(const Choice& choice, const BenchResult& result);

}  // namespace enc::bench
