// Fits the ball behind measured loops: the numbers of the ball's law by nonlinear least squares, each with an
// interval. It also reports the numbers that these loops do not determine.
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
  StandingBall start;                     // also the values of the held numbers
  std::array<bool, kBallNumbers> free{};  // numbers to fit
  BallFitOptions() { std::fill_n(free.begin(), kLoopNumbers, true); }
};

// Quality of an estimate, by the full width of its interval: within a fifth of its value; within its value;
// not determined.
enum class Known : std::uint8_t { well, poorly, not_at_all };

struct BallEstimate {
  std::size_t number = 0;     // index in ball_numbers()
  models::Interval interval;  // 95 %, SI; half is infinite if nothing is known
  double alone = kUnset;      // half, if all the others were given
  std::size_t tied = 0;       // the number with the most correlated error
  double correlation = 0.0;
  [[nodiscard]] double width() const;  // full width over the value; for nearer_mm over 0.1 mm
  [[nodiscard]] Known known() const;
};

// A held number, and its influence on the estimates.
struct HeldNumber {
  std::size_t number = 0;
  double value = 0.0;  // SI
  // Relative change of each estimate for a relative change of this number.
  std::vector<double> moves;
};

struct BallFit {
  StandingBall ball;
  std::vector<BallEstimate> estimates;  // same order as ball_numbers()
  std::vector<HeldNumber> held;
  double noise = 0.0;      // N rms, single reading
  double walk = 0.0;       // N / sqrt(s), zero
  double rms = 0.0;        // N, means over 10 ms minus the law; includes the zero's drift
  double condition = 0.0;  // condition of the information matrix, its columns scaled to length 1
  int steps = 0;
};

// Readings have correlated errors because the zero drifts, and white noise; both are estimated from the
// residuals (drifting_noise.h). Throws Error if the search does not converge.
[[nodiscard]] BallFit fit_ball(const BallLoops& loops, const BallFitOptions& options = {});

// N per scale of each of the numbers, one column each, by differences of `step` scales. For fit_ball and
// tests.
[[nodiscard]] Eigen::MatrixXd ball_jacobian(const BallLoops& loops, const StandingBall& ball,
                                            std::span<const std::size_t> numbers, double step = 1e-5);

}  // namespace enc::trial
