// The figures of a run under the names of `keep` in a sweep: paths into the output of `run --json`.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace enc::app {

struct RunReport;

// Everything that a sweep may keep. It has no times of the computer: they differ from run to run.
[[nodiscard]] nlohmann::ordered_json figures_json(const RunReport& report);

// The number at a path: keys and indices, separated by points. Of a list without an index: the mean of its
// entries, or what a last word asks: min, max, mean, sum, count. Unset if there is none. `misspelt` receives
// the first word that does not exist, with the names in its place.
struct UnknownWord {
  std::string word, names;
};
[[nodiscard]] double figure_at(const nlohmann::ordered_json& json, const std::string& path,
                               UnknownWord* misspelt = nullptr);

}  // namespace enc::app
