// Felt or not: errors of the twin, and of the paper, beside what a person can tell [sources/hand 6]. The
// thresholds stand in benchmarks/reference/thresholds.csv with their sources; nothing else knows a number.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"

namespace enc::bench {

// Where the paper [VHMR] contradicts itself. The report lists these; no benchmark has one as its target.

struct Contradiction {
  std::string id;       // "table2.A.release"
  std::string where;    // in the paper
  std::string printed;  // as it stands there
  std::string found;    // what the printed numbers give when computed with
};

// Computed from the printed numbers (benchmarks/reference), each time. `models`: the models folder.
[[nodiscard]] std::vector<Contradiction> contradictions(const std::string& models);

// A threshold is a range: `least` is what the most sensitive of studies, people or places asks for, `most`
// the least sensitive. All three are in the unit of the figure.
struct Threshold {
  std::string figure;      // id of what it is for; '*' stands for any characters
  int sign = 0;            // +1, -1: errors of this sign alone; 0: their size
  bool strictest = false;  // of a comparison that nobody makes so: above it nothing is known
  std::string compares;    // what a person holds against what; or why nobody can
  double value = kUnset, least = kUnset, most = kUnset;  // unset: not comparable
  std::string unit;
  std::string rule;  // in words: "7 % of 5 N, at least 0.1 N"
  std::string source, confidence;
};

enum class Felt : std::uint8_t { no, between, yes, not_comparable };
[[nodiscard]] const char* felt_name(Felt felt);

struct Judged {
  Figure figure;
  Threshold threshold;
  Felt felt = Felt::not_comparable, paper = Felt::not_comparable;
  double over = kUnset, paper_over = kUnset;  // size of the error over the threshold's value
};

// Throws Error with the row of what is wrong.
[[nodiscard]] std::vector<Threshold> load_thresholds(const std::string& models);
[[nodiscard]] std::vector<Threshold> parse_thresholds(const std::string& text, const std::string& name);

[[nodiscard]] bool matches(const std::string& pattern, const std::string& id);
[[nodiscard]] Felt felt(double error, const Threshold& threshold);
// Every figure that has a value and a threshold: by the first threshold that fits, in the figures' order.
[[nodiscard]] std::vector<Judged> judged(const std::vector<BenchResult>& results,
                                         const std::vector<Threshold>& thresholds);

// Without rows where nothing was judged.
[[nodiscard]] Table verdict_table(const std::vector<Judged>& all);
// What stands behind it: each threshold once.
[[nodiscard]] Table threshold_table(const std::vector<Judged>& all);
// The worst error of each threshold.
[[nodiscard]] Plot verdict_plot(const std::vector<Judged>& all);
// "12 not felt, 3 in between, 1 felt (a)"
[[nodiscard]] std::string verdict_line(const std::vector<Judged>& all);

}  // namespace enc::bench
