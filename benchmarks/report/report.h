// The report of a bench run: results.json (sources/choices 4), report.html, REPORT.md, and a CSV of every
// table and plot. Complete after each benchmark, and says what is missing.
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

// What does not depend on the run: the paper's contradictions, what a person can tell, and what people were
// asked.
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
  std::vector<std::string> missing;  // benchmarks that were asked for and have not ended
  std::vector<BenchResult> results{};
  std::map<std::string, std::string> drawings{};  // SVG by plot id
  std::string not_drawn{};                        // why a drawing is missing; empty: none is
  Background background{};
  trial::WallTime started = trial::wall_time();
  Plot verdict{};  // of the results so far; without names where nothing was judged
};

[[nodiscard]] const char* role_name(Role role);
// Those first that have a value of the paper in them.
[[nodiscard]] std::vector<const Plot*> ordered_plots(const Report& report);
[[nodiscard]] Table figure_table(const BenchResult& result);
[[nodiscard]] Table role_table(const Report& report);

[[nodiscard]] std::string results_json(const Report& report);
[[nodiscard]] std::string report_markdown(const Report& report);
[[nodiscard]] std::string report_html(const Report& report);

// Draws the plots of a result, and the verdict with it, and moves it from what is missing to the results.
void add_result(Report& report, BenchResult result);
// Every file whole or not at all (written aside, then renamed), so that a run that was killed leaves what was
// complete. Throws Error where the folder cannot be written.
void write_report(const std::string& folder, const Report& report);

}  // namespace enc::bench
