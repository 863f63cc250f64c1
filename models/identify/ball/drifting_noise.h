// The error of a force reading: white noise on a drifting zero. An estimate from such readings becomes exact
// least squares once the readings are "whitened", i.e. made independent of each other.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace enc::models {

// One mean of a few neighbouring readings, in order of time. `first` begins a new push, before which the zero
// was determined anew, so that nothing is known about it.
struct NoisyMean {
  double time = 0.0;    // s, middle of the readings
  double weight = 1.0;  // number of readings
  bool first = false;
};

// Random walk of the zero, variance per s over the variance of a reading, 1/s.
struct DriftingNoise {
  double walk = 0.0;
  // 2 / variance of its logarithm: equivalent number of squared normal numbers.
  double sureness = 0.0;
};

// Innovations of the local-level model (Kalman filter with an unknown start): rows of independent errors with
// the variance of one reading; the rows that begin a push become 0. Works on any columns that are linear in
// the error: residuals, Jacobian. Returns the sum of log variances.
double whiten(std::span<const NoisyMean> means, const DriftingNoise& noise,
              Eigen::Ref<Eigen::MatrixXd> columns);

// The most likely walk behind the residuals (each row a mean) of a fit with this Jacobian. Uses restricted
// likelihood (Patterson and Thompson, Biometrika 58, 1971), which accounts for the fitted parameters.
[[nodiscard]] DriftingNoise drifting_noise(std::span<const NoisyMean> means, const Eigen::VectorXd& residuals,
                                           const Eigen::MatrixXd& jacobian);

}  // namespace enc::models
