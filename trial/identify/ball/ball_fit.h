// Fits the ball behind measured loops: the numbers of the ball's law (sim/bodies/ball_plant.h) by nonlinear
// least squares, each with an interval. It also reports the numbers that these loops do not determine.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "models/identify/ball/drifting_noise.h"
#include "models/identify/block_fit.h"
#include "models/identify/response/response_fit.h"
#include "sim/bodies/ball_plant.h"

namespace enc::trial {

// The ball and its position in the rig.
struct StandingBall {
  sim::BallParameters law;
  // m: the ball is this much nearer to the probe than the deflection says, as if misplaced along the push.
  double nearer = 0.0;
};

// First the numbers that a loop of force and deflection determines, then those that are held unless freed.
inline constexpr std::size_t kRubberModulus = 0, kPressure = 1, kFeltModulus = 2, kFriction = 3,
                             kFrictionTravel = 4, kRelaxingFast = 5, kRelaxingMiddle = 6, kRelaxingSlow = 7,
                             kNearer = 8, kLoopNumbers = 9;
inline constexpr std::size_t kWall = 9, kFelt = 10, kRelaxationFast = 11, kRelaxationMiddle = 12,
                             kRelaxationSlow = 13, kBallNumbers = 14;

struct BallNumber {
  std::string_view name;  // includes its unit; follows "truth.ball.", except for nearer_mm
  double unit;            // SI value of 1
  double scale;           // SI, a usual value: the unit of the fit's steps
  bool elastic;           // changes the elastic force
  bool positive;          // true if 0 or less is not a ball
  double& (*of)(StandingBall&);
  std::string_view remedy;  // remedy if the loops do not determine it
};
[[nodiscard]] std::span<const BallNumber> ball_numbers();

[[nodiscard]] inline double value_of(const BallNumber& number, StandingBall ball) { return number.of(ball); }

// Consecutive pushes into a ball that was at rest before the first: readings with deflection > 0.
using Pushes = std::vector<std::vector<models::LoopPoint>>;

// One or more runs of a rig, each beginning with a ball at rest.
class BallLoops {
 public:
  explicit BallLoops(std::vector<Pushes> runs);

  // Means over a hundredth of a second, which the fit compares. The law is evaluated reading by reading.
  [[nodiscard]] std::span<const models::NoisyMean> means() const { return means_; }
  [[nodiscard]] const Eigen::VectorXd& measured() const { return measured_; }  // N, one for each mean
  [[nodiscard]] std::size_t pushes() const;
  [[nodiscard]] std::size_t readings() const { return readings_; }
  // The law's force at these means, N. nearer: distance by which the ball is nearer to the probe than the
  // deflection says, m.
  [[nodiscard]] Eigen::VectorXd predicted(const sim::BallPlant& ball, double nearer) const;

 private:
  std::vector<Pushes> runs_;
  std::vector<models::NoisyMean> means_;
  Eigen::VectorXd measured_;
  std::size_t readings_ = 0;
};

struct BallFitOptions {
  StandingBall start;                     // also the values of the held numbers
  std::array<bool, kBallNumbers> free{};  // numbers to fit
  BallFitOptions() { std::fill_n(free.begin(), kLoopNumbers, true); }
};

// Quality of an estimate, by the full width of its interval: within a fifth of its value; within its value;
// not determined.
enum class EstimateQuality : std::uint8_t { well, poorly, not_at_all };

struct BallEstimate {
  std::size_t number = 0;     // index in ball_numbers()
  models::Interval interval;  // 95 %, SI; half is infinite if nothing is known
  double alone = kUnset;      // half-width if all other numbers were known
  std::size_t tied = 0;       // the number with the most correlated error
  double correlation = 0.0;
  [[nodiscard]] double width() const;  // full width over the value; for nearer_mm over 0.1 mm
  [[nodiscard]] EstimateQuality known() const;
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

// N per scale of each of the numbers, one column each, by differences of `step` scales.
[[nodiscard]] Eigen::MatrixXd ball_jacobian(const BallLoops& loops, const StandingBall& ball,
                                            std::span<const std::size_t> numbers, double step = 1e-5);

}  // namespace enc::trial
