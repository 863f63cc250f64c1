// The figures of the last default run that the repository keeps, benchmarks/reference/figures.csv. The tables
// of the docs are written from them (docs/figures.py), and a run says which of its figures differ.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "benchmarks/kit/bench.h"
#include "benchmarks/verdict/reference.h"

namespace enc::bench {

struct CommittedFigure {
  double value = kUnset, least = kUnset, most = kUnset;
  std::string commit;  // that measured it
};

class Committed {
 public:
  Committed() = default;
  // Of the folder beside `models`; empty where the file is not there, as in an installed program.
  static Committed load(const std::string& models);
  static Committed parse(std::string_view text, const std::string& name);

  // Null: this file does not have it.
  [[nodiscard]] const CommittedFigure* find(const std::string& id) const;
  // Whether a figure is there and is another one: beside the spread of either run over seeds or repeats, and
  // by more than the four digits that are kept. A cost hangs on the machine, so it never differs.
  [[nodiscard]] bool differs(const Figure& figure) const;

 private:
  void take(const Reference& table);
  std::map<std::string, CommittedFigure> all_;
};

}  // namespace enc::bench
