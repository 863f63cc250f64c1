// Which chain of delays fits Table 1 [VHMR 4.1]? The theory is asked for thousands of chains, spread evenly;
// each is as likely as its misfit says. Bias and noise of each axis are those of the column at rest.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "benchmarks/tracking/table1.h"
#include "benchmarks/tracking/tracking_theory.h"

namespace enc::bench::tracking {

// What rig, truth and scene of a set-up say to the theory.
[[nodiscard]] ChainSpec chain_of(const models::Setup& setup);
[[nodiscard]] MovesSpec moves_of(const models::Setup& setup);

struct AxisError {
  double bias = 0.0, noise = 0.0;  // m
};
// Whose mean size and root mean square the column at rest prints.
[[nodiscard]] std::array<AxisError, 3> axis_errors(const Table1& paper);

[[nodiscard]] int way_of(BiasSide side);  // 1: along + of W, -1: along -, 0: both

struct Candidate {
  double fixed = 0.0, jitter = 0.0, acceleration = 0.0;  // s, s, m/s^2
  std::array<Table1, 3> table{};                         // by the theory, for each BiasSide
};
[[nodiscard]] Candidate candidate_of(const ChainSpec& chain, const MovesSpec& moves,
                                     const std::array<AxisError, 3>& axes);

struct Misfit {
  double moving20 = 0.0;  // rms of the relative differences of the six figures at 20 mm/s
  double moving = 0.0;    // of the twelve at 20 and 40 mm/s
  double worst = 0.0;     // largest difference, in units of what is asked: 13 % each, 6 % the norm
};
[[nodiscard]] Misfit misfit(const Table1& table, const Table1& paper);

// `count` candidates over fixed delay 2 to 30 ms, jitter 0 to 6 ms, acceleration 0.2 to 5 m/s^2 (even in its
// logarithm). Where `acceleration` is set it stays.
[[nodiscard]] std::vector<Candidate> spread(const ChainSpec& chain, const MovesSpec& moves,
                                            const std::array<AxisError, 3>& axes, std::size_t count,
                                            double acceleration);
// The best by `judge` (smaller is better), then looked for more closely around it.
enum class Judge : std::uint8_t { moving20, worst };
[[nodiscard]] Candidate best(const std::vector<Candidate>& candidates, const Table1& paper, BiasSide side,
                             Judge judge, const ChainSpec& chain, const MovesSpec& moves,
                             bool acceleration_free);

// What columns 0 and 20 alone leave open about column 40.
struct Predicted40 {
  Table1 low{}, median{}, high{};  // 5, 50 and 95 % of each figure
  std::vector<double> norm_rmse;   // m, of column 40, in order
  std::vector<std::size_t> drawn;  // candidates, as often as they are likely
};
// The size of the model's error and of one repetition's scatter is not known: it is judged by the misfit
// itself (Student's t).
[[nodiscard]] Predicted40 predict_40(const std::vector<Candidate>& candidates, const Table1& paper,
                                     BiasSide side, std::uint64_t seed);

}  // namespace enc::bench::tracking
