// Parts of the benchmark `indentation`; each adds its figures, plots and tables. [VHMR 4.2, Figs 8 and 10,
// Table 2]
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmarks/indentation/indent_run.h"
#include "benchmarks/kit/kit.h"

namespace enc::bench::indentation {

// A cell of Table 2 for each indentation and direction: index 2 i for pressing, 2 i + 1 for releasing.
inline constexpr std::size_t kCells = 6;
struct PaperCell {
  std::string indentation, way;
  double rmse = kUnset, mae = kUnset;  // N
  bool consistent = false;
};
[[nodiscard]] std::vector<PaperCell> paper_cells(const std::string& models);

// Over several runs: root of the mean square, mean of |e|, |mean of e|; least and greatest RMSE of a run.
struct Cell {
  double rmse = kUnset, mae = kUnset, bias = kUnset, least = kUnset, most = kUnset;  // N
};
enum class Reading : std::uint8_t { recorded, sensor, truth };
using IndentRuns = std::vector<std::vector<IndentRun>>;  // [i]: of indentation i
[[nodiscard]] Cell cell_of(const std::vector<IndentRun>& runs, Reading reading, bool press);
[[nodiscard]] std::vector<Cell> cells_of(const IndentRuns& runs, Reading reading);  // all six

struct IndentStudy {
  const BenchContext& context;
  std::vector<PaperCell> paper;
  std::vector<Response> curves;  // the rig's fit of A, B and C: the references
  std::uint64_t seed;            // seed of the first run
  std::size_t runs;              // of each indentation
  [[nodiscard]] IndentRuns all(const Words& own, std::size_t count) const;
};

// The error of a press of minimum jerk, from the chain's own numbers: threshold, lag x speed x slope, and the
// distance of the rendered law from the reference.
struct LagTheory {
  Response felt, reference;
  double depth, threshold, lag;  // m, N, s
};
[[nodiscard]] double predicted_rmse(const LagTheory& theory, double time);  // N; time: s, of the press
[[nodiscard]] double sensor_lag(const models::Setup& setup);

// The paper does not give the press time: RMSE over it. Also checks whether halving it has the effect that
// lag x speed x slope predicts.
void add_press_time(const IndentStudy& study, BenchResult& result);
// Share of the true force whose error a person may tell [sources/hand 6].
void add_deadband(const IndentRuns& runs, Bench& bench);
// The error of the other law between the two curves.
void add_energy_stop(const IndentStudy& study, Bench& bench);
// Neither force nor path depends on the time step: ratio of the true force's error at the shipped time step
// to that at a converged one.
void add_converged(const IndentStudy& study, BenchResult& result);
// A set of devices that follows the curves more closely, and its cost. Returns its six cells.
[[nodiscard]] std::vector<Cell> add_accuracy(const IndentStudy& study, const std::vector<Cell>& standard,
                                             BenchResult& result);
// Presses in directions without measured curves, against the rig's own push there.
void add_directions(const IndentStudy& study, BenchResult& result);
// Turns at 2 and at 4 mm, against the rig's ball.
void add_minor_loops(const IndentStudy& study, BenchResult& result);

}  // namespace enc::bench::indentation
