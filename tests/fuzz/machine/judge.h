// Runs one input through a target and says what is wrong with how it took it.
#pragma once

#include <string>

#include "tests/fuzz/machine/target.h"

namespace enc::fuzz {

struct Verdict {
  bool accepted = false;
  std::string wrong;          // empty: nothing
  std::size_t most_heap = 0;  // bytes
  double seconds = 0.0;       // of CPU time
};
[[nodiscard]] Verdict judge(const Target& target, const std::string& input);

// Writes the input to a file of the temporary folder and gives its name.
[[nodiscard]] std::string kept_input(const Target& target, const std::string& input);

// From now on a signal, a sanitizer's report and an input that takes more than kMostCpu of CPU time end the
// program with `words` and the file of the input that was being read.
inline constexpr int kMostCpu = 20;  // s
void watch(const std::string& words);

}  // namespace enc::fuzz
