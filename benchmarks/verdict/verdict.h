// Perceptible or not: errors of the twin and of the paper beside perception thresholds [sources/hand 6]. The
// thresholds and their sources stand in benchmarks/reference/thresholds.csv; no other file has these numbers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"

namespace enc::bench {

// Contradictions within a paper [VHMR, VisHap]. The report lists these; no benchmark has one as its target.

struct Contradiction {
  std::string id;       // "table2.A.release"
  std::string where;    // in the paper
  std::string printed;  // the printed text
  std::string found;    // the result computed from the printed numbers
};

// Computes the contradictions from the printed numbers (benchmarks/reference), each time. `models`: the
// models folder.
[[nodiscard]] std::vector<Contradiction> contradictions(const std::string& models);

// A threshold is a range: `least` is that of the most sensitive studies, people or places, `most` that of the
// least sensitive. All three are in the unit of the figure.
struct Threshold {
  std::string figure;      // id of its figure; '*' stands for any characters
  int sign = 0;            // +1, -1: errors of this sign alone; 0: their size
  bool strictest = false;  // threshold of a comparison stricter than real use: an error above it has no
                           // verdict
  std::string compares;    // the comparison that a person makes; or why none is possible
  double value = kUnset, least = kUnset, most = kUnset;  // unset: not comparable
  std::string unit;
  std::string rule;  // rule in words: "7 % of 5 N, at least 0.1 N"
  std::string source, confidence;
};

enum class Perception : std::uint8_t { no, between, yes, not_comparable };
[[nodiscard]] const char* felt_name(Perception felt);

struct FigureVerdict {
  Figure figure;
  Threshold threshold;
  Perception felt = Perception::not_comparable, paper = Perception::not_comparable;
  double over = kUnset, paper_over = kUnset;  // size of the error over the threshold's value
};

// Throws Error with the row of the error.
[[nodiscard]] std::vector<Threshold> load_thresholds(const std::string& models);
[[nodiscard]] std::vector<Threshold> parse_thresholds(const std::string& text, const std::string& name);

[[nodiscard]] bool matches(const std::string& pattern, const std::string& id);
[[nodiscard]] Perception felt(double error, const Threshold& threshold);
// Every figure that has a value and a threshold: by the first threshold that fits, in the figures' order.
[[nodiscard]] std::vector<FigureVerdict> judged(const std::vector<BenchResult>& results,
                                                const std::vector<Threshold>& thresholds);

// Empty if no figure was judged.
[[nodiscard]] Table verdict_table(const std::vector<FigureVerdict>& all);
// The sources of the verdict: each threshold once.
[[nodiscard]] Table threshold_table(const std::vector<FigureVerdict>& all);
// The worst error of each threshold.
[[nodiscard]] Plot verdict_plot(const std::vector<FigureVerdict>& all);
// "12 not felt, 3 in between, 1 felt (a)"
[[nodiscard]] std::string verdict_line(const std::vector<FigureVerdict>& all);

}  // namespace enc::bench
