// What ball is behind measured loops: the numbers of the ball's law by nonlinear least squares, each with an
// interval, and what these loops do not tell.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "models/identify/block_error.h"
#include "trial/identify/ball/ball_loops.h"
#include "trial/identify/ball/ball_numbers.h"

namespace enc::trial {

struct BallFitOptions {
  StandingBall start;                     // also what is held
  std::array<bool, kBallNumbers> free{};  // to be found
  BallFitOptions() { std::fill_n(free.begin(), kLoopNumbers, true); }
};

// How well a number is known, by the full width of its interval: within a fifth of its value; within its
// value; not at all.
enum class Known : std::uint8_t { well, poorly, not_at_all };

struct BallEstimate {
  std::size_t number = 0;     // of ball_numbers()
  models::Interval interval;  // 95 %, SI; half is infinite where nothing is known
  double alone = kUnset;      // half, if all the others were given
  std::size_t tied = 0;       // the number with which its error goes together most
  double correlation = 0.0;
  [[nodiscard]] double width() const;  // full, over the value; of nearer_mm over 0.1 mm
  [[nodiscard]] Known known() const;
};

// A number that was not looked for: what the estimates owe to it.
struct HeldNumber {
  std::size_t number = 0;
  double value = 0.0;  // SI
  std::vector<double>
      moves;  // change of each estimate over its value, for a change of this one over its value
};

struct BallFit {
  StandingBall ball;
  std::vector<BallEstimate> estimates;  // in the order of ball_numbers()
  std::vector<HeldNumber> held;
  double noise = 0.0;      // N rms of a reading
  double walk = 0.0;       // N / sqrt(s), of the zero
  double rms = 0.0;        // N, of means over 10 ms less the law; what the zero does is not taken away
  double condition = 0.0;  // of the information matrix, its columns scaled to length 1
  int steps = 0;
};

// Readings err alike because the zero wanders, and by white noise; both are estimated from the residuals
// (drifting_noise.h). Throws Error where the search does not settle.
[[nodiscard]] BallFit fit_ball(const BallLoops& loops, const BallFitOptions& options = {});

// N per scale of each of the numbers, a column each, by differences of `step` scales. For fit_ball and tests.
[[nodiscard]] Eigen::MatrixXd ball_jacobian(const BallLoops& loops, const StandingBall& ball,
                                            std::span<const std::size_t> numbers, double step = 1e-5);

}  // namespace enc::trial
