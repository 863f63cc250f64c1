// What the words after `bench` name: benchmarks, groups of them, figures or the beginnings of their ids.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"

namespace enc::bench {

struct Group {
  const char* name;
  const char* what;
  std::vector<std::string> members;  // those that are not there are passed over
};
[[nodiscard]] std::span<const Group> groups();

struct Choice {
  const Benchmark* benchmark;
  std::vector<std::string> ids;  // whole ids or their first tokens; empty: all figures
};
// In the order named, each benchmark once; no words: all. Throws Error for a word that names nothing here.
[[nodiscard]] std::vector<Choice> chosen(const std::vector<std::string>& words);
// For --set: those with a scene or a rig in the folder `models`. One without, which --set could not change,
// is refused where it was named (throws Error) and left out of all; `left` has their names.
[[nodiscard]] std::vector<Choice> settable(std::vector<Choice> choices, bool named, const std::string& models,
                                           std::vector<std::string>& left);
// For --rig: those that can be measured over devices, likewise; the others are left out of all without a
// word.
[[nodiscard]] std::vector<Choice> over_devices(std::vector<Choice> choices, bool named);
[[nodiscard]] bool wanted(const Choice& choice, const Figure& figure);
// Only a run knows the ids. Throws Error, with the nearest one, where an id was named that there is not.
void check_ids(const Choice& choice, const BenchResult& result);

}  // namespace enc::bench
