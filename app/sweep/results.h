// The results of a complete sweep for people and other programs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "trial/sweep/design.h"
#include "trial/sweep/shard.h"
#include "trial/sweep/spec.h"

namespace enc::app {

// All runs, by column.
struct SweepTable {
  const trial::SweepSpec& spec;
  std::string program;
  std::vector<std::vector<std::string>> parameters;  // by axis, then by run
  std::vector<std::vector<double>> figures;          // by kept measure, then by run; unset: none
  std::vector<int> exits;                            // by run
  std::vector<std::string> errors;                   // of failed runs, "run 7: ..."
  std::vector<double> cpu;                           // s, by run

  [[nodiscard]] std::int64_t failures() const;
  [[nodiscard]] std::int64_t crossed() const;  // runs that crossed limits: their figures count
};

// Writes results.ndjson, results.csv, cost.csv and report.html. The first two are equal to the bit whatever
// the number of shards was.
SweepTable write_results(const std::string& folder, const trial::SweepSpec& spec,
                         const trial::SweepIdentity& identity);

// The page: a table of the figures, the share of each parameter, and their pictures.
[[nodiscard]] std::string sweep_page(const SweepTable& whole);

}  // namespace enc::app
