#include "models/identify/ball/drifting_noise.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace enc::models {

double whiten(std::span<const NoisyMean> means, const DriftingNoise& noise,
              Eigen::Ref<Eigen::MatrixXd> columns) {
  Eigen::RowVectorXd level(columns.cols());
  double known = 0.0;  // variance of the level, in units of a reading's variance
  double logs = 0.0;
  for (std::size_t i = 0; i < means.size(); ++i) {
    auto row = columns.row(static_cast<Eigen::Index>(i));
    const double own = 1.0 / means[i].weight;
    if (means[i].first) {
      level = row;
      known = own;
      row.setZero();
      continue;
    }
    known += noise.walk * (means[i].time - means[i - 1].time);
    const double variance = known + own;
    const double gain = known / variance;
    row -= level;
    level += gain * row;
    known *= 1.0 - gain;
    row /= std::sqrt(variance);
    logs += std::log(variance);
  }
  return logs;
}

DriftingNoise drifting_noise(std::span<const NoisyMean> means, const Eigen::VectorXd& residuals,
                             const Eigen::MatrixXd& jacobian) {
  const auto pushes = std::count_if(means.begin(), means.end(), [](const NoisyMean& m) { return m.first; });
  const double freedom = static_cast<double>(residuals.size() - pushes - jacobian.cols());
  Eigen::MatrixXd columns(residuals.size(), jacobian.cols() + 1);
  columns << residuals, jacobian;
  // Minus twice the logarithm of the likelihood, at the best-fitting size of the noise.
  const auto unlikely = [&](double log_walk) {
    Eigen::MatrixXd white = columns;
    const double logs = whiten(means, {std::exp(log_walk)}, white);
    const auto design = white.rightCols(jacobian.cols());
    const Eigen::LDLT<Eigen::MatrixXd> gram(design.transpose() * design);
    const Eigen::VectorXd moment = design.transpose() * white.col(0);
    const double squares = white.col(0).squaredNorm() - moment.dot(gram.solve(moment));
    return freedom * std::log(std::max(squares, 1e-300)) + logs +
           gram.vectorD().cwiseMax(1e-300).array().log().sum();
  };
  // Golden-section search, from a walk that no minute shows to a zero that never returns.
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  double low = std::log(1e-5);
  double high = std::log(1e5);
  double a = high - ratio * (high - low);
  double b = low + ratio * (high - low);
  double at_a = unlikely(a);
  double at_b = unlikely(b);
  while (high - low > 0.05) {
    const bool left = at_a < at_b;
    (left ? high : low) = left ? b : a;
    (left ? b : a) = left ? a : b;
    (left ? at_b : at_a) = left ? at_a : at_b;
    double& probe = left ? a : b;
    probe = left ? high - ratio * (high - low) : low + ratio * (high - low);
    (left ? at_a : at_b) = unlikely(probe);
  }
  constexpr double kStep = 0.5;
  const double best = 0.5 * (low + high);
  const double bend = unlikely(best - kStep) - 2.0 * unlikely(best) + unlikely(best + kStep);
  return {std::exp(best), std::max(0.0, bend / (kStep * kStep))};
}

}  // namespace enc::models
