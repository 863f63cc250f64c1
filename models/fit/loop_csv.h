// A measured loop as a file: comma-separated columns time_s, deflection_mm, force_N, repeat, found by name;
// others are ignored (sources/choices 9). A real rig's readings and the simulated rig's are read alike.
#pragma once

#include <string>
#include <vector>

#include "models/fit/response_fit.h"

namespace enc::models {

struct LoopData {
  // One entry for each repeat: its readings with deflection > 0, in the order of time.
  std::vector<std::vector<LoopPoint>> presses;
  // The same without those at standstill, where it is neither pressed nor released.
  std::vector<std::vector<LoopPoint>> moving;
  // Who measured what: the text of the column `source` in a press, else of the comment lines (#) before the
  // header; empty where the file does not say.
  std::string remark;
};

// Rows without a repeat, or with repeat 0, or with a deflection of 0 or less, belong to no press. name: of
// the file, for messages "name:line:column: ...". Throws Error.
[[nodiscard]] LoopData parse_loop(const std::string& text, const std::string& name, double limit);

}  // namespace enc::models
