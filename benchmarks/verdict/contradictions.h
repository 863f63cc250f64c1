// Where the paper [VHMR] contradicts itself. The report lists these; no benchmark has one as its target.
#pragma once

#include <string>
#include <vector>

namespace enc::bench {

struct Contradiction {
  std::string id;       // "table2.A.release"
  std::string where;    // in the paper
  std::string printed;  // as it stands there
  std::string found;    // what the printed numbers give when computed with
};

// Computed from the printed numbers (benchmarks/reference), each time. `models`: the models folder.
[[nodiscard]] std::vector<Contradiction> contradictions(const std::string& models);

}  // namespace enc::bench
