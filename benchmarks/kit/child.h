// Another program, run to its end: gnuplot, which draws, or Encounter itself, whose size and start are
// measured.
#pragma once

#include <string>
#include <vector>

namespace enc::bench {

struct Child {
  int code = -1;  // exit code; -1: could not be started, or a signal ended it
  bool started = false;
  std::string out, err;
  double cpu = 0.0, wall = 0.0;  // s
};

// The first word is looked for in PATH. What it reads and writes goes through memory files: nothing is left
// behind.
[[nodiscard]] Child run_child(std::vector<std::string> words, const std::string& input = {});

}  // namespace enc::bench
