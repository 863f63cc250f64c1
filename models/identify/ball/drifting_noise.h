// The error of a force reading: white noise on a zero that wanders. What is estimated from such readings is
// exact least squares once both are divided by what they do to each other: "whitened".
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace enc::models {

// One mean of a few neighbouring readings. Neighbours in time follow one another; `first` begins a new push,
// before which the zero has been found anew, so that it is nothing that is known.
struct NoisyMean {
  double time = 0.0;    // s, of the middle
  double weight = 1.0;  // readings in it
  bool first = false;
};

// Random walk of the zero, variance per s over the variance of a reading, 1/s.
struct DriftingNoise {
  double walk = 0.0;
  double sureness =
      0.0;  // 2 / variance of its logarithm: as many squares of normal numbers would tell as much
};

// Innovations of the local-level model (Kalman's filter with an unknown start): rows of independent errors
// with the variance of one reading; the rows that begin a push become 0. Works on any columns that are linear
// in the error: residuals, Jacobian. Gives the sum of log variances.
double whiten(std::span<const NoisyMean> means, const DriftingNoise& noise,
              Eigen::Ref<Eigen::MatrixXd> columns);

// The most likely walk behind the residuals (each row a mean) of a fit with this Jacobian: restricted
// likelihood (Patterson and Thompson, Biometrika 58, 1971), which allows for what the fit has taken out of
// them.
[[nodiscard]] DriftingNoise drifting_noise(std::span<const NoisyMean> means, const Eigen::VectorXd& residuals,
                                           const Eigen::MatrixXd& jacobian);

}  // namespace enc::models
