// A case of `bench extremes`: something that should not happen, done to a whole trial, with the criterion
// that it has to meet.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "benchmarks/extremes/judge.h"
#include "benchmarks/kit/kit.h"

namespace enc::bench::extremes {

inline constexpr double kInfinite = HUGE_VAL;

// A number that was measured, with the bounds that are the criterion; without bounds it is only stated.
struct Number {
  std::string what;  // last tokens of its id, behind those of the case
  double value = kUnset;
  const char* unit = "";
  Bounds bounds{};
  std::string note{};
  double wanted = kUnset;  // a criterion that is not met, and cannot be: by how much is said; no bound
  bool cost = false;       // Figure::cost
};

struct Found {
  std::string did, criterion;  // for the table: what was done, what has to be
  std::vector<Number> numbers{};
  double simulated = 0.0;  // s
  std::string words{};     // beside the verdict; such as what physics does not allow
};

[[nodiscard]] inline double time_of(const trial::Glance& glance) {  // s
  return seconds(glance.tick.t.time_since_epoch());
}

struct Case {
  std::string id;  // tokens between the benchmark's name and those of a number
  std::function<Found(const BenchContext&)> run;
};
using Cases = std::vector<Case>;

// A run with a judge, which takes the trial's hook `watch`; `also` looks on, too.
struct Run {
  trial::TrialResult result;
  Judge judge;
};
[[nodiscard]] Run judged(const models::Setup& setup, trial::TrialOptions options,
                         const std::function<void(const trial::Glance&)>& also = {});
// What every case shows of its runs: ticks on which the judge found something wrong, and warnings of the
// engine.
void add_soundness(const Run& run, Found& found);

// The tables of cases, one for each file.
void add_walls(Cases& cases, bool quick);
void add_touches(Cases& cases, bool quick);
void add_inputs(Cases& cases, bool quick);
void add_links(Cases& cases, bool quick);
void add_places(Cases& cases, bool quick);
void add_refusals(Cases& cases, bool quick);
void add_soaks(Cases& cases, bool quick, bool full);
// Hours of both machines, one after the other because memory is of the whole program: run at once, added to
// both.
void add_long(Bench& bench, Cases& cases, std::vector<Found>& found);
// Force over the stiffness of the arm's walls.
void add_wall_plot(Bench& bench, const Cases& cases, const std::vector<Found>& found);
// Error against run time.
void add_error_over_time(Bench& bench);

}  // namespace enc::bench::extremes
