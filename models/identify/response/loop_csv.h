// A measured loop as a file: comma-separated columns time_s, deflection_mm, force_N, repeat, found by name;
// others are ignored (sources/choices 9). The format is equal for a real rig and the simulated one.
#pragma once

#include <string>
#include <vector>

#include "models/identify/response/response_fit.h"

namespace enc::models {

struct LoopData {
  // One entry for each repeat: its readings with deflection > 0, in order of time.
  std::vector<std::vector<LoopPoint>> presses;
  // The readings of either branch among these: neither at standstill nor so near to the deepest that both
  // mix.
  std::vector<std::vector<LoopPoint>> moving;
  // Origin of the data: the text of the column `source` in a press, else of the comment lines (#) before the
  // header; empty if the file has neither.
  std::string remark;
  // First corrections, each with its standard deviation: a force that is not 0 before contact, and a contact
  // that does not begin at 0.
  std::vector<std::string> notes;
  // One of the notes explains why the curves are unreliable.
  bool doubted = false;
  double zero_error = 0.0;   // N
  double begin_error = 0.0;  // m
};

// Rows without a repeat, with repeat 0, or from before contact belong to no press; they give the zero of the
// force and the begin of contact. name: of the file, for messages "name:line:column: ...". Throws Error.
[[nodiscard]] LoopData parse_loop(const std::string& text, const std::string& name, double limit);

}  // namespace enc::models
