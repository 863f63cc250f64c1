// Fits chains of delays to Table 1 [VHMR 4.1]. The theory is evaluated for thousands of chains, spread
// evenly; the misfit of a chain gives its likelihood. Bias and noise of each axis are those of the column at
// rest.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "benchmarks/tracking/table1.h"
#include "trial/measure/programme_measures.h"

namespace enc::bench::tracking {

// The expected errors of Table 1 for a chain of delays and a motion, from the numbers of the chain alone and
// without a simulator. A packet that reaches the core at a tick shows the place of the tool one age ago:
//   age = fixed delay + wait for the server's tick + exponential delay + wait for the core's tick,
//   error = x(t - age) - x(t) + bias + noise

struct ChainSpec {
  double rate = 120.0, server_rate = 100.0;  // Hz, free-running
  double fixed = 0.0;                        // s, from exposure to server, including its application
  double jitter = 0.0;                       // s, mean of the exponential part
  double tick = 1e-3;                        // s, of the core
};

// `count` equally likely ages, s: means of equal parts of their distribution. A packet that a later one
// overtakes never counts.
[[nodiscard]] std::vector<double> likely_ages(const ChainSpec& chain, std::size_t count = 16);
[[nodiscard]] double mean_age(const ChainSpec& chain);

// One way along an axis from stop to stop: the servo's response to the commanded trapezoids.
struct MovesSpec {
  std::vector<double> stops{0.0, 0.005, 0.010, 0.020, 0.040};  // m
  double speed = 0.020;                                        // m/s
  double acceleration = 0.41;                                  // m/s^2, of command and servo
  double servo = 15.0, damping = 0.8;                          // Hz, -
  double fastest = 0.050;                                      // m/s, of the servo
  double step = 1e-3;                                          // s, of the servo's simulation
};

using trial::Errors;
using trial::kMoving;

[[nodiscard]] Errors at_stops(double bias, double noise);

// Place of the tool one age ago less its present place, over all moving ticks and ages.
class Lag {
 public:
  Lag(const std::vector<double>& ages, const MovesSpec& moves);
  // way: 1 towards + of the axis, -1 towards -, 0 both. Bias (fixed in the room) and noise: m.
  [[nodiscard]] Errors errors(double bias, double noise, int way = 1) const;

 private:
  struct Bin {
    double lag = 0.0, share = 0.0;
  };
  std::vector<Bin> bins_;
  double mean_ = 0.0, square_ = 0.0;
};

// The chain that rig, truth and scene of a set-up define.
[[nodiscard]] ChainSpec chain_of(const models::Setup& setup);
[[nodiscard]] MovesSpec moves_of(const models::Setup& setup);

struct AxisError {
  double bias = 0.0, noise = 0.0;  // m
};
// Axes with the mean size and root mean square of the column at rest.
[[nodiscard]] std::array<AxisError, 3> axis_errors(const Table1& paper);

struct Candidate {
  double fixed = 0.0, jitter = 0.0, acceleration = 0.0;  // s, s, m/s^2
  std::array<Table1, 3> table{};                         // theory's table, for each BiasSide
};
[[nodiscard]] Candidate candidate_of(const ChainSpec& chain, const MovesSpec& moves,
                                     const std::array<AxisError, 3>& axes);

struct Misfit {
  double moving20 = 0.0;  // rms of the relative differences of the six figures at 20 mm/s
  double moving = 0.0;    // rms over the twelve figures at 20 and 40 mm/s
  double worst = 0.0;     // largest difference, in units of the required accuracy: 13 % each, 6 % the norm
};
[[nodiscard]] Misfit misfit(const Table1& table, const Table1& paper);

// `count` candidates over fixed delay 2 to 30 ms, jitter 0 to 6 ms, acceleration 0.2 to 5 m/s^2 (even in its
// logarithm). A given `acceleration` stays fixed.
[[nodiscard]] std::vector<Candidate> spread(const ChainSpec& chain, const MovesSpec& moves,
                                            const std::array<AxisError, 3>& axes, std::size_t count,
                                            double acceleration);
// The best by `judge` (smaller is better), refined by a finer search around it.
enum class Judge : std::uint8_t { moving20, worst };
[[nodiscard]] Candidate best(const std::vector<Candidate>& candidates, const Table1& paper, BiasSide side,
                             Judge judge, const ChainSpec& chain, const MovesSpec& moves,
                             bool acceleration_free);

// The range of column 40 that columns 0 and 20 leave open.
struct Predicted40 {
  Table1 low{}, median{}, high{};  // 5, 50 and 95 % of each figure
  std::vector<double> norm_rmse;   // m, of column 40, in order
  std::vector<std::size_t> drawn;  // candidates, drawn by their likelihood
};
// The size of the model's error and of one repetition's scatter is unknown: the misfit itself estimates it
// (Student's t).
[[nodiscard]] Predicted40 predict_40(const std::vector<Candidate>& candidates, const Table1& paper,
                                     BiasSide side, std::uint64_t seed);

// Adds figures `tracking.predicted.*`, plots and tables to the benchmark `tracking`.
void add_prediction(const BenchContext& context, BenchResult& result);

}  // namespace enc::bench::tracking
