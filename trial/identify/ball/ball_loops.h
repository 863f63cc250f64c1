// Measured pushes into a ball, and the forces of the ball's law for equal path and time.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "models/identify/ball/drifting_noise.h"
#include "models/identify/response/response_fit.h"
#include "sim/bodies/ball_plant.h"

namespace enc::trial {

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

}  // namespace enc::trial
