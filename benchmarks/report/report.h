// The report of a bench run: results.json (sources/choices 4), report.html, REPORT.md, and a CSV of every
// table and plot. It is complete after each benchmark, and lists the missing results.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "benchmarks/questionnaire/opinion.h"
#include "benchmarks/verdict/verdict.h"
#include "trial/provenance/provenance.h"

namespace enc::bench {

// The part that does not depend on the run: the paper's contradictions, perception thresholds, and the
// questionnaire.
struct Background {
  std::vector<Contradiction> contradictions;
  std::vector<Threshold> thresholds;
  std::vector<questionnaire::ItemReference> items;
};
[[nodiscard]] Background load_background(const std::string& models);

struct Report {
  std::string command;  // that made it
  std::uint64_t seed = 1;
  std::vector<std::string> set;      // the user's overrides
  std::vector<std::string> missing;  // benchmarks that were requested and have not ended
  std::vector<BenchResult> results{};
  std::map<std::string, std::string> drawings{};  // SVG by plot id
  std::string not_drawn{};                        // why a drawing is missing; empty: all are there
  Background background{};
  trial::WallTime started = trial::wall_time();
  Plot verdict{};  // plot of the results so far; without names if no figure was judged
};

[[nodiscard]] const char* role_name(Role role);
// twin - paper if the bounds exclude the paper's value, so that the twin is known to miss it; else unset.
[[nodiscard]] double miss_of(const Figure& figure);
[[nodiscard]] inline bool misses(const Figure& figure) { return std::isfinite(miss_of(figure)); }
// Plots with a value of the paper come first.
[[nodiscard]] std::vector<const Plot*> ordered_plots(const Report& report);
[[nodiscard]] Table figure_table(const BenchResult& result);
[[nodiscard]] Table role_table(const Report& report);
// Each figure of the paper that the twin predicts and that has bounds.
[[nodiscard]] Table predicted_table(const Report& report);

[[nodiscard]] std::string results_json(const Report& report);
[[nodiscard]] std::string report_markdown(const Report& report);
[[nodiscard]] std::string report_html(const Report& report);

// Draws the plots of a result and the verdict, and moves the result from the missing ones to the results.
void add_result(Report& report, BenchResult result);
// Writes every file whole or not at all (written aside, then renamed), so that a killed run leaves its
// complete part. Throws Error if the folder cannot be written.
void write_report(const std::string& folder, const Report& report);

}  // namespace enc::bench
