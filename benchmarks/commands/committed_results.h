// The figures of the last default run that the repository keeps, benchmarks/reference/figures.csv. The tables
// of the docs are written from them (docs/figures.py), and a run says which of its figures differ.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "benchmarks/verdict/reference.h"

namespace enc::bench {

struct CommittedFigure {
  double value = kUnset, least = kUnset, most = kUnset;
  std::string commit;  // that measured it
  bool bounded = false;
};

class CommittedResults {
 public:
  CommittedResults() = default;
  // Loads from the folder beside `models`; empty if the file does not exist, as in an installed program.
  static CommittedResults load(const std::string& models);
  static CommittedResults parse(std::string_view text, const std::string& name);

  // Null if this file does not have the figure.
  [[nodiscard]] const CommittedFigure* find(const std::string& id) const;
  // Ids of the benchmark's figures that have bounds.
  [[nodiscard]] std::vector<std::string> bounded(const std::string& benchmark) const;
  // Reports whether the figure exists and differs: it lies outside the spread of either run over seeds or
  // repeats, by more than the four stored digits. A cost depends on the machine, so it never differs.
  [[nodiscard]] bool differs(const Figure& figure) const;

 private:
  void take(const Reference& table);
  std::map<std::string, CommittedFigure> all_;
};

}  // namespace enc::bench
